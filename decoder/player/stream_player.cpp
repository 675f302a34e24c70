#include "decoder/player/stream_player.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

namespace rlpc {
namespace {

// A page can address 4 GiB: enough for two decoders with this limit, and the data drawn.
constexpr std::uint64_t kMaxMemoryBytes = std::uint64_t{3} << 29;

}  // namespace

Placement placement_of(const SequenceHeader& header) {
  return {std::ldexp(1.0, 1 - header.position_bits), {}};
}

Placement placement_in(const SequenceHeader& header, const SequenceHeader& other) {
  const double unit = placement_of(other).scale;
  Placement placement{std::ldexp(unit, header.grid.log2_step - other.grid.log2_step), {}};
  for (std::size_t c = 0; c < 3; ++c) {
    placement.offset[c] = header.grid.origin[c] * placement.scale - other.grid.origin[c] * unit;
  }
  return placement;
}

Vec3d centred_coordinates(std::span<const std::int32_t> positions, const Placement& placement,
                          std::span<float> coordinates) {
  Vec3d middle{};  // centre of the grid
  Vec3d centre{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::int32_t least = positions[c];
    std::int32_t most = positions[c];
    for (std::size_t i = c; i < positions.size(); i += 3) {
      least = std::min(least, positions[i]);
      most = std::max(most, positions[i]);
    }
    middle[c] = std::midpoint<double>(least, most);
    centre[c] = middle[c] * placement.scale + placement.offset[c];
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    coordinates[i] = static_cast<float>((positions[i] - middle[i % 3]) * placement.scale);
  }
  return centre;
}

StreamPlayer::StreamPlayer(OpenSource open_source, std::uint32_t stream,
                           std::uint64_t num_bytes)
    : open_source_(open_source), stream_(stream), num_bytes_(num_bytes) {}

std::optional<Decoder> StreamPlayer::open_decoder(bool verify_hashes) {
  DecoderOptions options;
  options.verify_hashes = verify_hashes;
  options.limits.max_memory_bytes = kMaxMemoryBytes;
  auto decoder = Decoder::open(open_source_(stream_, num_bytes_), options);
  if (decoder) return std::move(*decoder);
  error_ = decoder.error();
  return std::nullopt;
}

bool StreamPlayer::open() {
  decoder_ = open_decoder(true);
  if (!decoder_) return false;
  placement_ = placement_of(decoder_->header());
  positions_.resize(3 * std::size_t{decoder_->header().num_vertices});
  coordinates_.resize(positions_.size());
  return true;
}

bool StreamPlayer::decode_with(std::optional<Decoder>& decoder, std::uint32_t frame) {
  if (failed_ || decoder->position() != frame) {
    if (const auto ok = decoder->seek(frame); !ok) {
      error_ = ok.error();
      return false;
    }
  }
  const auto more = decoder->next_frame(positions_);
  if (!more) error_ = more.error();
  return static_cast<bool>(more);
}

bool StreamPlayer::decode(std::uint32_t frame) {
  hash_differs_ = false;
  failed_ = !decode_with(decoder_, frame);
  if (failed_) {
    hash_differs_ = std::string_view(error_.rule) == "R-HSH-02";
    if (!hash_differs_) return false;
    if (!unchecked_) unchecked_ = open_decoder(false);
    if (!unchecked_ || !decode_with(unchecked_, frame)) return false;
  }
  centre_ = centred_coordinates(positions_, placement_, coordinates_);
  return true;
}

bool StreamPlayer::finish() {
  const auto more = decoder_->next_frame(positions_);
  if (!more) error_ = more.error();
  return static_cast<bool>(more);
}

}  // namespace rlpc
