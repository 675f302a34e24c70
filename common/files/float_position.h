// Converts decoded positions and frame numbers to floats (clause 7.3), for output and metrics,
// after the decoding process, which is integer-only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Returns (position + origin) * 2^log2_step, in units of the input, rounded once to float: the
// sum has at most 28 bits, so the product is exact in double. -150 <= grid.log2_step <= 120.
inline float float_position(const Grid& grid, std::size_t axis, std::int32_t position) {
  const auto bits = static_cast<std::uint64_t>(1023 + grid.log2_step) << 52;
  double power = 0;
  std::memcpy(&power, &bits, sizeof power);  // std::bit_cast, which Emscripten's library lacks
  const std::int64_t steps = std::int64_t{position} + grid.origin[axis];
  return static_cast<float>(static_cast<double>(steps) * power);
}

// Returns the seconds from frame 0 to `frame`.
inline float frame_time(FrameRate frame_rate, std::uint32_t frame) {
  return static_cast<float>(static_cast<double>(frame) * frame_rate.denominator /
                            frame_rate.numerator);
}

}  // namespace rlpc
