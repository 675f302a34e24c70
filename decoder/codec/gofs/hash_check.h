// 8.6.2 Hash check of one GOF: verifies decoded positions against the hashes of the stream.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/syntax/gof_hash.h"

namespace rlpc {

class HashCheck {
 public:
  HashCheck() = default;  // no hash
  // num_frames: frames of the GOF.
  HashCheck(std::optional<GofHash> hash, FrameCrcs frame_crcs, std::uint32_t num_frames);

  // Restarts at the first frame of the GOF.
  void restart();
  // Hashes frame f of the GOF, in decoded order. Returns false if the frame, or the GOF that it
  // completes, does not match its hash. A hash of the whole GOF needs all frames in order.
  bool add_frame(std::uint32_t f, std::span<const std::int32_t> positions);
  // Returns the place of the hash that the last add_frame found wrong, if it is that of a
  // single frame.
  std::optional<std::uint64_t> failed_at() const { return failed_at_; }
  // Returns the number of frames that the last add_frame verified: all frames of a GOF that it
  // completed.
  std::uint32_t compared_frames() const { return compared_frames_; }

 private:
  std::optional<GofHash> hash_;
  FrameCrcs frame_crcs_;
  std::optional<std::uint64_t> failed_at_;
  std::uint32_t num_frames_ = 0;
  std::uint32_t running_crc_ = 0;
  std::uint32_t hashed_frames_ = 0;  // consecutive frames in running_crc_
  std::uint32_t compared_frames_ = 0;
};

}  // namespace rlpc
