// 6.7 GOF hash, and hashes of single frames.
#pragma once

#include <cstdint>
#include <optional>

#include "common/memory/owned.h"

namespace rlpc {

struct GofHash {
  bool per_frame_flag = false;
  Vector<std::uint32_t> position_crc;  // one per frame, or one for the GOF
};

// 7.14.2: frame_crc, and its place in the stream.
struct FrameCrc {
  std::uint32_t crc = 0;
  std::uint64_t bit_pos = 0;

  bool operator==(const FrameCrc& other) const { return crc == other.crc; }
};

// frame_crc of each frame of a GOF that has one; empty if none has.
using FrameCrcs = Vector<std::optional<FrameCrc>>;

}  // namespace rlpc
