#include "encoder/codec/metrics/surface_metrics.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "encoder/codec/metrics/points.h"

namespace rlpc {
namespace {

// Returns a normal whose length is twice the area of the triangle.
Vec3d normal(std::span<const float> xyz, const Triangle& t) {
  const Vec3d p = point_at(xyz, t[0]);
  return cross(minus(point_at(xyz, t[1]), p), minus(point_at(xyz, t[2]), p));
}

double root_of_squares(double a, double b) { return std::sqrt(a * a + b * b); }

}  // namespace

SurfaceAccumulator::SurfaceAccumulator(std::uint32_t num_vertices,
                                       std::span<const Triangle> triangles)
    : triangles_(triangles.begin(), triangles.end()),
      sted_spatial_(num_vertices, triangles),
      sted_temporal_(num_vertices),
      ring_(num_vertices, triangles),
      normal_errors_(num_vertices, triangles) {}

void SurfaceAccumulator::add_frame(std::span<const float> original,
                                   std::span<const float> decoded) {
  FrameSurface frame;
  if (frames_.empty()) starts_as_point_ = box_diagonal(original) == 0.0;
  frame.sted_spatial = sted_spatial_.add_frame(original, decoded);
  sted_temporal_.add_frame(original, decoded);
  const RingEdgeDifference::Parts ring = ring_.add_frame(original, decoded);
  if (!frames_.empty()) frames_.back().ring_temporal = ring.previous_temporal;
  frame.ring_spatial = ring.spatial;
  add_normals(original, decoded, frame);
  const NormalErrors::OfFrame errors = normal_errors_.add_frame(original, decoded);
  frame.vertex_normals = errors.deviation.rms();
  frame.normal_flicker = errors.flicker.rms();
  normal_deviation_ += errors.deviation;
  normal_flicker_ += errors.flicker;
  frames_.push_back(frame);
}

void SurfaceAccumulator::add_normals(std::span<const float> original,
                                     std::span<const float> decoded, FrameSurface& frame) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  double angles = 0;
  double areas = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Vec3d n = normal(original, triangles_[t]);
    const double area = length(n) / 2;
    if (area == 0) continue;
    const Vec3d m = normal(decoded, triangles_[t]);
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
  m.has_sted = !starts_as_point_;
  const std::vector<double> steps = sted_temporal_.steps();
  for (std::size_t f = 1; f < frames_.size() && m.has_sted; ++f) {
    m.frames[f].sted_temporal = steps[f - 1];
  }
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    m.sted_spatial += m.frames[f].sted_spatial;
    m.sted_temporal += m.frames[f].sted_temporal;
    m.ring_spatial += frames_[f].ring_spatial;
    m.ring_temporal += frames_[f].ring_temporal;
    if (frames_[f].max_normal_angle > m.max_normal_angle) {
      m.max_normal_angle = frames_[f].max_normal_angle;
      m.max_normal_frame = static_cast<std::uint32_t>(f);
      m.max_normal_triangle = frames_[f].max_normal_triangle;
    }
  }
  const auto num_frames = static_cast<double>(frames_.size());
  m.sted_spatial /= num_frames;
  if (frames_.size() > 1) m.sted_temporal /= num_frames - 1;
  if (m.has_sted)
    m.sted = root_of_squares(m.sted_spatial, kStedTemporalWeight * m.sted_temporal);
  m.ring_spatial /= num_frames;
  if (frames_.size() > 2) m.ring_temporal /= num_frames - 2;
  m.ring_difference = root_of_squares(m.ring_spatial, m.ring_temporal);
  if (area_sum_ > 0) m.mean_normal_angle = angle_sum_ / area_sum_;
  m.vertex_normals = normal_deviation_.rms();
  m.normal_flicker = normal_flicker_.rms();
  return m;
}

}  // namespace rlpc
