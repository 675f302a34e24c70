// Motion of vertices in a local coordinate frame (Amjoun and Strasser 2007, 3.2).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/codec/kinds/cluster/recon/lcf.h"

namespace rlpc {

// Converts positions to local coordinates, both in grid units: the inverse of 8.4.3 in floating
// point.
struct LocalFrame {
  explicit LocalFrame(const Lcf& lcf);

  std::array<double, 3> to_local(const double* xyz) const {
    const double x = xyz[0] - origin[0];
    const double y = xyz[1] - origin[1];
    const double z = xyz[2] - origin[2];
    std::array<double, 3> q{};
    for (std::size_t k = 0; k < 3; ++k) {
      q[k] = (axis[k][0] * x + axis[k][1] * y + axis[k][2] * z) * kAxisUnit;
    }
    return q;
  }

  static constexpr double kAxisUnit = 1.0 / (1 << kAxisFractionBits);  // fixed: format
  std::array<double, 3> origin{};
  std::array<std::array<double, 3>, 3> axis{};  // in units of kAxisUnit
};

enum class DistanceSum : std::uint8_t { kSquared, kPlain };

// Adds to motion[v] the distance, squared or plain, between the local coordinates of vertex v
// and `before`, then replaces `before` by the new local coordinates.
//
//   xyz     [num_vertices][3]  grid units
//   before  [num_vertices][3]  local coordinates in the previous frame; updated
//   motion  [num_vertices]     squared or plain grid units; accumulated
void add_local_motion(DistanceSum sum, const LocalFrame& frame, std::size_t num_vertices,
                      const double* xyz, double* before, double* motion) noexcept;

}  // namespace rlpc
