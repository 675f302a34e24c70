#include "encoder/metrics/surface_metrics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace rlpc {
namespace {

using Vec3 = std::array<double, 3>;

Vec3 point(std::span<const float> xyz, std::uint32_t vertex) {
  const std::size_t i = 3 * std::size_t{vertex};
  return {xyz[i], xyz[i + 1], xyz[i + 2]};
}

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

// A normal whose length is twice the area of the triangle.
Vec3 normal(std::span<const float> xyz, const Triangle& t) {
  const Vec3 p = point(xyz, t[0]);
  return cross(minus(point(xyz, t[1]), p), minus(point(xyz, t[2]), p));
}

double diagonal(std::span<const float> xyz) {
  Vec3 low = point(xyz, 0);
  Vec3 high = low;
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], static_cast<double>(xyz[i]));
    high[i % 3] = std::max(high[i % 3], static_cast<double>(xyz[i]));
  }
  return length(minus(high, low));
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> edges_of(std::span<const Triangle> triangles) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      if (low != high) edges.push_back({low, high});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

double StedAccumulator::Pair::difference() const {
  return std::abs(original - decoded) / original;
}

StedAccumulator::StedAccumulator(std::uint32_t num_vertices,
                                 std::span<const Triangle> triangles)
    : num_vertices_(num_vertices),
      edges_(edges_of(triangles)),
      temporal_edges_(num_vertices),
      lengths_(edges_.size()),
      weight_(num_vertices),
      mean_(num_vertices),
      variance_(num_vertices) {
  assert(num_vertices > 0);
}

StedAccumulator::Parts StedAccumulator::add_frame(std::span<const float> original,
                                                  std::span<const float> decoded) {
  assert(original.size() == 3 * std::size_t{num_vertices_} &&
         decoded.size() == original.size());
  Parts parts;
  if (previous_original_.empty()) {
    frame_distance_ = kDt * diagonal(original);
  } else {
    parts.previous_temporal = temporal_part(original, decoded);
  }
  parts.spatial = spatial_part(original, decoded);
  previous_original_.assign(original.begin(), original.end());
  previous_decoded_.assign(decoded.begin(), decoded.end());
  return parts;
}

// Computes the mean first, then the squares: the result is exactly 0 if all edges change by the
// same ratio.
double StedAccumulator::spatial_part(std::span<const float> original,
                                     std::span<const float> decoded) {
  std::fill(weight_.begin(), weight_.end(), 0.0);
  std::fill(mean_.begin(), mean_.end(), 0.0);
  std::fill(variance_.begin(), variance_.end(), 0.0);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [a, b] = edges_[e];
    lengths_[e] = {length(minus(point(original, a), point(original, b))),
                   length(minus(point(decoded, a), point(decoded, b)))};
    if (lengths_[e].original == 0) continue;
    for (const std::uint32_t v : edges_[e]) {
      weight_[v] += lengths_[e].original;
      mean_[v] += lengths_[e].original * lengths_[e].difference();
    }
  }
  for (std::uint32_t v = 0; v < num_vertices_; ++v) {
    if (weight_[v] > 0) mean_[v] /= weight_[v];
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (lengths_[e].original == 0) continue;
    for (const std::uint32_t v : edges_[e]) {
      const double d = lengths_[e].difference() - mean_[v];
      variance_[v] += lengths_[e].original * d * d;
    }
  }
  double sum = 0;
  for (std::uint32_t v = 0; v < num_vertices_; ++v) {
    if (weight_[v] > 0) sum += std::sqrt(variance_[v] / weight_[v]);
  }
  return sum / num_vertices_;
}

double StedAccumulator::temporal_part(std::span<const float> original,
                                      std::span<const float> decoded) {
  double sum = 0;
  for (std::uint32_t v = 0; v < num_vertices_; ++v) {
    const Vec3 step = minus(point(original, v), point(previous_original_, v));
    const Vec3 decoded_step = minus(point(decoded, v), point(previous_decoded_, v));
    const double apart = frame_distance_ * frame_distance_;
    const Pair next{std::sqrt(dot(step, step) + apart),
                    std::sqrt(dot(decoded_step, decoded_step) + apart)};
    const Pair before = temporal_edges_[v];
    temporal_edges_[v] = next;
    if (before.original == 0 || next.original == 0) continue;
    // For two values, dev is their distance times the geometric mean of their normalised
    // weights.
    const double weight = before.original + next.original;
    sum += std::abs(before.difference() - next.difference()) *
           std::sqrt(before.original * next.original) / weight;
  }
  return sum / num_vertices_;
}

SurfaceAccumulator::SurfaceAccumulator(std::uint32_t num_vertices,
                                       std::span<const Triangle> triangles)
    : triangles_(triangles.begin(), triangles.end()), sted_(num_vertices, triangles) {}

void SurfaceAccumulator::add_frame(std::span<const float> original,
                                   std::span<const float> decoded) {
  const StedAccumulator::Parts sted = sted_.add_frame(original, decoded);
  if (!frames_.empty()) frames_.back().sted_temporal = sted.previous_temporal;
  FrameSurface frame;
  frame.sted_spatial = sted.spatial;
  add_normals(original, decoded, frame);
  frames_.push_back(frame);
}

void SurfaceAccumulator::add_normals(std::span<const float> original,
                                     std::span<const float> decoded, FrameSurface& frame) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  double angles = 0;
  double areas = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Vec3 n = normal(original, triangles_[t]);
    const double area = length(n) / 2;
    if (area == 0) continue;
    const Vec3 m = normal(decoded, triangles_[t]);
    const double angle =
        length(m) == 0 ? 90.0 : kDegrees * std::atan2(length(cross(n, m)), dot(n, m));
    angles += angle * area;
    areas += area;
    if (angle > frame.max_normal_angle) {
      frame.max_normal_angle = angle;
      frame.max_normal_triangle = static_cast<std::uint32_t>(t);
    }
  }
  if (areas > 0) frame.mean_normal_angle = angles / areas;
  angle_sum_ += angles;
  area_sum_ += areas;
}

SurfaceMetrics SurfaceAccumulator::result() const {
  assert(!frames_.empty());
  SurfaceMetrics m;
  m.frames = frames_;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    m.sted_spatial += frames_[f].sted_spatial;
    m.sted_temporal += frames_[f].sted_temporal;
    if (frames_[f].max_normal_angle > m.max_normal_angle) {
      m.max_normal_angle = frames_[f].max_normal_angle;
      m.max_normal_frame = static_cast<std::uint32_t>(f);
      m.max_normal_triangle = frames_[f].max_normal_triangle;
    }
  }
  m.sted_spatial /= static_cast<double>(frames_.size());
  if (frames_.size() > 2) m.sted_temporal /= static_cast<double>(frames_.size() - 2);
  const double temporal = StedAccumulator::kTemporalWeight * m.sted_temporal;
  m.sted = std::sqrt(m.sted_spatial * m.sted_spatial + temporal * temporal);
  if (area_sum_ > 0) m.mean_normal_angle = angle_sum_ / area_sum_;
  return m;
}

}  // namespace rlpc
