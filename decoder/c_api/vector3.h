// Vectors in floating point, for positions and normals that leave the decoder.
#pragma once

#include <array>

namespace rlpc {

using Vec3d = std::array<double, 3>;

inline double dot(const Vec3d& a, const Vec3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace rlpc
