#include "decoder/codec/gofs/hash_check.h"

#include <utility>

#include "common/codec/bits/crc32.h"

namespace rlpc {

HashCheck::HashCheck(std::optional<GofHash> hash, FrameCrcs frame_crcs,
                     std::uint32_t num_frames)
    : hash_(std::move(hash)), frame_crcs_(std::move(frame_crcs)), num_frames_(num_frames) {}

void HashCheck::restart() {
  running_crc_ = 0;
  hashed_frames_ = 0;
}

bool HashCheck::add_frame(std::uint32_t f, std::span<const std::int32_t> positions) {
  compared_frames_ = 0;
  if (f < frame_crcs_.size() && frame_crcs_[f]) {
    compared_frames_ = 1;
    if (crc32_of_positions(positions) != frame_crcs_[f]->crc) {
      failed_at_ = frame_crcs_[f]->bit_pos;
      return false;
    }
  }
  if (!hash_) return true;
  if (hash_->per_frame_flag) {
    compared_frames_ = 1;
    return crc32_of_positions(positions) == hash_->position_crc[f];
  }
  if (hashed_frames_ != f) return true;
  running_crc_ = crc32_of_positions(positions, running_crc_);
  ++hashed_frames_;
  if (hashed_frames_ < num_frames_) return true;
  compared_frames_ = hashed_frames_;
  return running_crc_ == hash_->position_crc[0];
}

}  // namespace rlpc
