#include "decoder/web/wasm/frame_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "decoder/surface/attribute_values.h"

namespace rlpc {
namespace {

Vec3f point(std::span<const float> coordinates, std::uint32_t v) {
  const float* p = coordinates.data() + 3 * std::size_t{v};
  return {p[0], p[1], p[2]};
}

Vec3f difference(const Vec3f& a, const Vec3f& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vec3f cross(const Vec3f& a, const Vec3f& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3f unit(const Vec3f& n) {
  // Scaled by its size first, because the squares of very small numbers underflow.
  const float size = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
  if (!(size > 0.0F)) return {0, 0, 1};
  const Vec3f m{n[0] / size, n[1] / size, n[2] / size};
  const float length = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
  return {m[0] / length, m[1] / length, m[2] / length};
}

}  // namespace

FrameExtent extent_of(std::span<const std::int32_t> positions) {
  FrameExtent extent;
  for (std::size_t c = 0; c < 3; ++c) {
    std::int32_t min = positions[c];
    std::int32_t max = positions[c];
    for (std::size_t i = c; i < positions.size(); i += 3) {
      min = std::min(min, positions[i]);
      max = std::max(max, positions[i]);
    }
    extent.min[c] = min;
    extent.max[c] = max;
  }
  return extent;
}

void centred_coordinates(std::span<const std::int32_t> positions, const FrameExtent& extent,
                         int position_bits, std::span<float> coordinates) {
  const double scale = std::ldexp(1.0, 1 - position_bits);
  std::array<double, 3> middle{};
  for (std::size_t c = 0; c < 3; ++c) {
    middle[c] = std::midpoint<double>(extent.min[c], extent.max[c]);
  }
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    for (std::size_t c = 0; c < 3; ++c) {
      coordinates[i + c] = static_cast<float>((positions[i + c] - middle[c]) * scale);
    }
  }
}

void vertex_normals(std::span<const float> coordinates, std::span<const Triangle> triangles,
                    std::vector<Vec3f>& normals) {
  normals.assign(coordinates.size() / 3, {});
  for (const Triangle& t : triangles) {
    const Vec3f a = point(coordinates, t[0]);
    const Vec3f n =
        cross(difference(point(coordinates, t[1]), a), difference(point(coordinates, t[2]), a));
    for (const std::uint32_t v : t) {
      for (std::size_t c = 0; c < 3; ++c) normals[v][c] += n[c];
    }
  }
  std::transform(normals.begin(), normals.end(), normals.begin(), unit);
}

void unit_normals(std::span<const double> sums, std::vector<Vec3f>& normals) {
  normals.resize(sums.size() / 3);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const auto n = unit_normal(&sums[3 * i]);
    for (std::size_t c = 0; c < 3; ++c) normals[i][c] = static_cast<float>(n[c]);
  }
}

std::vector<std::array<std::uint32_t, 2>> drawn_edges(std::span<const Triangle> triangles) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace rlpc
