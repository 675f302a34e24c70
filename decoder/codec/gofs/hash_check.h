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
  // num_frames: of the GOF.
  HashCheck(std::optional<GofHash> hash, FrameCrcs frame_crcs, std::uint32_t num_frames);

  // Restarts at the first frame of the GOF.
  void restart();
  // Frame f of the GOF, in decoded order. False if it, or the GOF that it completes, does not
  // match its hash. A hash of the whole GOF needs all frames in order.
  bool add_frame(std::uint32_t f, std::span<const std::int32_t> positions);
  // Where the hash is that the last add_frame found wrong, if it is that of a frame of its own.
  std::optional<std::uint64_t> failed_at() const { return failed_at_; }
  // Number of frames that the last add_frame verified: all of the GOF if it completed it.
  std::uint32_t compared_frames() const { return compared_frames_; }

 private:
  std::optional<GofHash> hash_;
  FrameCrcs frame_crcs_;
  std::optional<std::uint64_t> failed_at_;
  std::uint32_t num_frames_ = 0;
  std::uint32_t running_crc_ = 0;
  std::uint32_t hashed_frames_ = 0;  // consecutive ones, in running_crc_
  std::uint32_t compared_frames_ = 0;
};

}  // namespace rlpc
