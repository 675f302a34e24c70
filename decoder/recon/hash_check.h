// 8.6.2 Hash check, of one GOF: decoded positions against the hashes of the stream.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/syntax/gof_hash.h"

namespace rlpc {

class HashCheck {
 public:
  HashCheck() = default;  // nothing to compare with
  // num_frames: of the GOF.
  HashCheck(GofHash hash, std::uint32_t num_frames);

  // The next frame is the first one of the GOF, again.
  void restart();
  // Frame f of the GOF, in decoded order. False if it, or the GOF that it completes, does not
  // fit its hash. A hash of the whole GOF needs all of its frames in order.
  bool add_frame(std::uint32_t f, std::span<const std::int32_t> positions);
  // How many frames the last add_frame compared: all of them if it completed the GOF.
  std::uint32_t compared_frames() const { return compared_frames_; }

 private:
  std::optional<GofHash> hash_;
  std::uint32_t num_frames_ = 0;
  std::uint32_t running_crc_ = 0;
  std::uint32_t hashed_frames_ = 0;  // consecutive ones, in running_crc_
  std::uint32_t compared_frames_ = 0;
};

}  // namespace rlpc
