// Motion of vertices as seen from a local coordinate frame (Amjoun and Strasser 2007, 3.2).
#pragma once

#include <array>
#include <cstddef>

#include "common/cluster_gof/recon/lcf.h"

namespace rlpc {

// The inverse of 8.4.3 in floating point: grid units from there, as they are in the frame.
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

// Adds to motion[v] the squared distance of each vertex from where it was, which becomes where
// it is.
//
//   xyz     [num_vertices][3]
//   before  [num_vertices][3], local
//   motion  [num_vertices]
void add_local_motion(const LocalFrame& frame, std::size_t num_vertices, const double* xyz,
                      double* before, double* motion) noexcept;

}  // namespace rlpc
