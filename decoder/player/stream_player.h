// Frames of a stream in any order, as a player shows them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "decoder/player/frame_surface.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

using Vec3d = std::array<double, 3>;

// Where grid positions are drawn: position * scale + offset.
struct Placement {
  double scale = 1;
  Vec3d offset{};
};

// In the cube from -1 to 1, which is what position_bits can reach.
Placement placement_of(const SequenceHeader& header);
// The positions of `header` in the cube of another stream.
Placement placement_in(const SequenceHeader& header, const SequenceHeader& other);

// Coordinates of a frame from the centre of its box, which is returned: 24 bits, all that the
// numbers of a graphics card have, then go to the mesh, and not to its way. As many of both.
Vec3d centred_coordinates(std::span<const std::int32_t> positions, const Placement& placement,
                          std::span<float> coordinates);

class StreamPlayer {
 public:
  // source(): the stream once more; called at most twice.
  using OpenSource = std::unique_ptr<ByteSource> (*)(std::uint32_t stream,
                                                     std::uint64_t num_bytes);

  StreamPlayer(OpenSource open_source, std::uint32_t stream, std::uint64_t num_bytes);

  // Each of these is false if the stream has an error, which error() tells.
  bool open();
  // Decodes a frame below num_frames; only if it is not the next one, with a seek. A frame that
  // does not fit its hash is decoded all the same: true, hash_differs(), and error() says it.
  bool decode(std::uint32_t frame);
  // After the last frame: checks the rest of the stream.
  bool finish();
  const Error& error() const { return error_; }

  // After open().
  const Decoder& decoder() const { return *decoder_; }
  void set_placement(const Placement& placement) { placement_ = placement; }

  // Of the frame that was decoded last.
  std::span<const std::int32_t> positions() const { return positions_; }
  std::span<const float> coordinates() const { return coordinates_; }  // from the centre
  const Vec3d& centre() const { return centre_; }
  bool hash_differs() const { return hash_differs_; }
  std::uint32_t compared_frames() const { return decoder_->compared_frames(); }

 private:
  std::optional<Decoder> open_decoder(bool verify_hashes);
  bool decode_with(std::optional<Decoder>& decoder, std::uint32_t frame);

  OpenSource open_source_;
  std::uint32_t stream_;
  std::uint64_t num_bytes_;
  std::optional<Decoder> decoder_;
  std::optional<Decoder> unchecked_;  // for frames that do not fit their hash
  bool failed_ = false;               // of decoder_: it needs a seek
  bool hash_differs_ = false;
  Error error_;
  Placement placement_;
  std::vector<std::int32_t> positions_;
  std::vector<float> coordinates_;
  Vec3d centre_{};
};

}  // namespace rlpc
