#include "encoder/codec/metrics/vertex_normals.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

namespace rlpc {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

template <class T>
Vec3d point(std::span<const T> xyz, std::uint32_t vertex) {
  const std::size_t i = 3 * std::size_t{vertex};
  return {static_cast<double>(xyz[i]), static_cast<double>(xyz[i + 1]),
          static_cast<double>(xyz[i + 2])};
}

// Unit normals and areas of all vertices; a normal is zero where there is none.
struct VertexNormals {
  std::vector<Vec3d> normal;  // [vertex]
  std::vector<double> area;   // [vertex]
};

template <class T>
VertexNormals vertex_normals(std::span<const Triangle> triangles, std::span<const T> xyz) {
  VertexNormals found{std::vector<Vec3d>(xyz.size() / 3), std::vector<double>(xyz.size() / 3)};
  for (const Triangle& t : triangles) {
    const Vec3d p = point(xyz, t[0]);
    const Vec3d n = cross(minus(point(xyz, t[1]), p), minus(point(xyz, t[2]), p));
    const double part = length(n) / 6.0;
    for (const std::uint32_t v : t) {
      for (std::size_t c = 0; c < 3; ++c) found.normal[v][c] += n[c];
      found.area[v] += part;
    }
  }
  for (Vec3d& n : found.normal) {
    const double size = length(n);
    for (double& c : n) c = size > 0.0 ? c / size : 0.0;
  }
  return found;
}

bool is_zero(const Vec3d& a) { return a[0] == 0.0 && a[1] == 0.0 && a[2] == 0.0; }

// Returns the angle between two unit vectors, degrees.
double angle(const Vec3d& a, const Vec3d& b) {
  return kDegrees * 2.0 * std::asin(std::min(length(minus(a, b)) / 2.0, 1.0));
}

// Returns the squared angles between the normals of two frames; the areas are those of the
// first.
SquaredAngles deviation(const VertexNormals& a, const VertexNormals& b) {
  SquaredAngles angles;
  for (std::size_t v = 0; v < a.normal.size(); ++v) {
    if (is_zero(a.normal[v])) continue;
    constexpr double kRight = 90.0;
    const double off = is_zero(b.normal[v]) ? kRight : angle(a.normal[v], b.normal[v]);
    angles += {off * off * a.area[v], a.area[v]};
  }
  return angles;
}

}  // namespace

SquaredAngles normal_deviation(std::span<const Triangle> triangles,
                               std::span<const double> original,
                               std::span<const float> decoded) {
  if (triangles.empty()) return {};
  return deviation(vertex_normals(triangles, original), vertex_normals(triangles, decoded));
}

NormalErrors::NormalErrors(std::uint32_t num_vertices, std::span<const Triangle> triangles)
    : triangles_(triangles.begin(), triangles.end()), error_(num_vertices) {}

NormalErrors::OfFrame NormalErrors::add_frame(std::span<const float> original,
                                              std::span<const float> decoded) {
  const VertexNormals a = vertex_normals(std::span<const Triangle>(triangles_), original);
  const VertexNormals b = vertex_normals(std::span<const Triangle>(triangles_), decoded);
  OfFrame errors{deviation(a, b), {}};
  for (std::size_t v = 0; v < error_.size(); ++v) {
    const Vec3d error = minus(b.normal[v], a.normal[v]);
    const double change = kDegrees * length(minus(error, error_[v]));
    error_[v] = error;
    if (!has_frame_ || is_zero(a.normal[v])) continue;
    errors.flicker += {change * change * a.area[v], a.area[v]};
  }
  has_frame_ = true;
  return errors;
}

}  // namespace rlpc
