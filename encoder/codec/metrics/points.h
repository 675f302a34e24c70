// Positions and differences of vertices, in doubles, for the metrics.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace rlpc {

using Vec3d = std::array<double, 3>;

inline Vec3d point_at(std::span<const float> xyz, std::uint32_t vertex) {
  const std::size_t i = 3 * std::size_t{vertex};
  return {xyz[i], xyz[i + 1], xyz[i + 2]};
}

inline Vec3d minus(const Vec3d& a, const Vec3d& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double dot(const Vec3d& a, const Vec3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double length(const Vec3d& a) { return std::sqrt(dot(a, a)); }

inline double distance(std::span<const float> xyz, std::uint32_t a, std::uint32_t b) {
  return length(minus(point_at(xyz, a), point_at(xyz, b)));
}

// Returns the diagonal of the bounding box of at least one vertex.
inline double box_diagonal(std::span<const float> xyz) {
  Vec3d low = point_at(xyz, 0);
  Vec3d high = low;
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    low[i % 3] = std::fmin(low[i % 3], static_cast<double>(xyz[i]));
    high[i % 3] = std::fmax(high[i % 3], static_cast<double>(xyz[i]));
  }
  return length(minus(high, low));
}

}  // namespace rlpc
