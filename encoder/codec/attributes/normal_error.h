// Decoded frames, and how far their normals are from those of the input.
#pragma once

#include <cstdint>
#include <vector>

namespace rlpc {

// Decoded positions, in decoded order.
struct DecodedFrame {
  std::uint32_t frame = 0;
  std::vector<std::int32_t> positions;
};

// Differences of the normals of a frame, in degrees, each sector weighted by its area relative
// to the largest that it has in any of the compared frames.
struct NormalError {
  std::uint32_t frame = 0;
  double mean = 0.0;
  double rms = 0.0;
  double largest = 0.0;  // over sectors with at least a hundredth of their largest area
};

}  // namespace rlpc
