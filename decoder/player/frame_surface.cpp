#include "decoder/player/frame_surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace rlpc {
namespace {

using Vec3f = std::array<float, 3>;

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

PackedNormal packed(const Vec3f& n) {
  // Scaled by its size first, because the squares of very small numbers underflow.
  const float size = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
  if (!(size > 0.0F)) return {0, 0, 32767, 0};
  const Vec3f m{n[0] / size, n[1] / size, n[2] / size};
  const float scale = 32767.0F / std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
  return {static_cast<std::int16_t>(m[0] * scale), static_cast<std::int16_t>(m[1] * scale),
          static_cast<std::int16_t>(m[2] * scale), 0};
}

}  // namespace

void vertex_normals(std::span<const float> coordinates, std::span<const Triangle> triangles,
                    std::vector<PackedNormal>& normals) {
  const std::size_t num_vertices = coordinates.size() / 3;
  std::vector<Vec3f> sums(num_vertices);
  for (const Triangle& t : triangles) {
    const Vec3f a = point(coordinates, t[0]);
    const Vec3f n =
        cross(difference(point(coordinates, t[1]), a), difference(point(coordinates, t[2]), a));
    for (const std::uint32_t v : t) {
      for (std::size_t c = 0; c < 3; ++c) sums[v][c] += n[c];
    }
  }
  normals.resize(num_vertices);
  std::transform(sums.begin(), sums.end(), normals.begin(), packed);
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

Box box_of(std::span<const float> coordinates) {
  Box box{point(coordinates, 0), point(coordinates, 0)};
  for (std::size_t i = 3; i < coordinates.size(); ++i) {
    box.least[i % 3] = std::min(box.least[i % 3], coordinates[i]);
    box.most[i % 3] = std::max(box.most[i % 3], coordinates[i]);
  }
  return box;
}

Deviation vertex_distances(std::span<const float> coordinates, std::span<const float> reference,
                           const std::array<double, 3>& shift, std::vector<float>& distances) {
  assert(coordinates.size() == reference.size());
  distances.resize(coordinates.size() / 3);
  double sum = 0;
  float largest = 0;
  for (std::size_t v = 0; v < distances.size(); ++v) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t i = 3 * v + c;
      const double d = double{coordinates[i]} - double{reference[i]} + shift[c];
      square += d * d;
    }
    sum += square;
    distances[v] = static_cast<float>(std::sqrt(square));
    largest = std::max(largest, distances[v]);
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, distances.size()));
  return {largest, static_cast<float>(std::sqrt(sum / count))};
}

}  // namespace rlpc
