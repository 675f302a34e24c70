#include "decoder/web/wasm/seeking_decoder.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "decoder/codec/units/find_gof_index.h"

namespace rlpc {

SeekingDecoder::SeekingDecoder(OpenSource open_source, const DecoderOptions& options)
    : open_source_(std::move(open_source)), options_(options) {}

std::optional<Decoder> SeekingDecoder::open_decoder(bool verify_hashes) {
  DecoderOptions options = options_;
  options.verify_hashes = verify_hashes;
  auto decoder = Decoder::open(open_source_(), options);
  if (decoder) return std::move(*decoder);
  error_ = decoder.error();
  return std::nullopt;
}

bool SeekingDecoder::open() {
  decoder_ = open_decoder(options_.verify_hashes);
  if (!decoder_) return false;
  positions_.resize(3 * std::size_t{decoder_->num_vertices()});
  return true;
}

bool SeekingDecoder::find_index() {
  UnitReader units(open_source_(), nullptr, options_.limits.max_memory_bytes);
  const auto index = find_gof_index(units, kStreamHeaderBytes, decoder_->header());
  if (!index) {
    error_ = index.error();
    return false;
  }
  landmarks_.clear();
  for (const GofLocation& gof : index->gofs) landmarks_.push_back(gof.offset);
  for (const RigLocation& rig : index->rigs) landmarks_.push_back(rig.offset);
  if (landmarks_.empty()) return true;
  std::sort(landmarks_.begin(), landmarks_.end());
  landmarks_.push_back(units.size());
  return true;
}

std::uint32_t SeekingDecoder::num_frames() {
  std::uint32_t frames = decoder_->num_frames().value_or(0);
  if (frames > 0) return frames;
  while (frames < kMaxFrames) {
    const auto gof = decoder_->gof_of(frames);
    if (!gof) break;
    frames = gof->first_frame + gof->num_frames;
  }
  return std::max(frames, std::uint32_t{1});
}

bool SeekingDecoder::decode_with(std::optional<Decoder>& decoder, std::uint32_t frame) {
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

bool SeekingDecoder::decode(std::uint32_t frame) {
  frame_ = frame;
  hash_differs_ = false;
  failed_ = !decode_with(decoder_, frame);
  if (!failed_) return true;
  hash_differs_ = std::string_view(error_.rule) == "R-HSH-02";
  if (!hash_differs_) return false;
  const Error difference = error_;
  if (!unchecked_) unchecked_ = open_decoder(false);
  if (!unchecked_ || !decode_with(unchecked_, frame)) return false;
  error_ = difference;
  return true;
}

bool SeekingDecoder::finish() {
  // Repeats the last call if bytes were missing.
  if (failed_ && !decode_with(decoder_, frame_)) return false;
  // An open-ended stream may have more frames than its end declares.
  auto more = decoder_->next_frame(positions_);
  while (more && *more) more = decoder_->next_frame(positions_);
  if (!more) error_ = more.error();
  failed_ = !more;
  return !failed_;
}

bool SeekingDecoder::decode_attributes() {
  if (sets_) return true;
  failed_ = true;  // decode() needs a seek
  // Seeks to the place that the decoder returns to; ignores errors of other frames.
  static_cast<void>(decoder_->seek(0));
  auto sets = decoder_->attributes();
  if (!sets) {
    error_ = sets.error();
    return false;
  }
  sets_ = std::move(*sets);
  const auto triangles = decoder_->triangles();
  drawn_.emplace(drawable_sets(*sets_, triangles), triangles, decoder_->num_vertices());
  return true;
}

bool SeekingDecoder::read_asset() {
  if (asset_) return true;
  auto asset = decoder_->asset();
  if (asset) {
    asset_ = std::move(*asset);
  } else {
    error_ = asset.error();
  }
  return asset_.has_value();
}

}  // namespace rlpc
