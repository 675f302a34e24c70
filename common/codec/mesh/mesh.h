// Plain types shared by encoder and decoder: triangles, positions, frame rate, grid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace rlpc {

// Three vertex indices; the order gives the orientation.
using Triangle = std::array<std::uint32_t, 3>;

// Position in grid units, or displacement.
using Vec3i = std::array<std::int32_t, 3>;

// Frames per second as a fraction, both parts at least 1.
struct FrameRate {
  std::uint32_t numerator = 30;
  std::uint32_t denominator = 1;
  bool operator==(const FrameRate&) const = default;
};

// Grid of the decoded positions (clause 7.3): coordinate = (position + origin) * 2^log2_step.
struct Grid {
  std::int32_t log2_step = 0;
  std::array<std::int32_t, 3> origin{};
  bool operator==(const Grid&) const = default;
};

}  // namespace rlpc
