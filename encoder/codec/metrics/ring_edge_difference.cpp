#include "encoder/codec/metrics/ring_edge_difference.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "encoder/codec/metrics/points.h"
#include "encoder/codec/metrics/sted.h"

namespace rlpc {

double RingEdgeDifference::Pair::difference() const {
  return std::abs(original - decoded) / original;
}

RingEdgeDifference::RingEdgeDifference(std::uint32_t num_vertices,
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

RingEdgeDifference::Parts RingEdgeDifference::add_frame(std::span<const float> original,
                                                        std::span<const float> decoded) {
  assert(original.size() == 3 * std::size_t{num_vertices_} &&
         decoded.size() == original.size());
  Parts parts;
  if (previous_original_.empty()) {
    frame_distance_ = kDt * box_diagonal(original);
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
double RingEdgeDifference::spatial_part(std::span<const float> original,
                                        std::span<const float> decoded) {
  std::fill(weight_.begin(), weight_.end(), 0.0);
  std::fill(mean_.begin(), mean_.end(), 0.0);
  std::fill(variance_.begin(), variance_.end(), 0.0);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [a, b] = edges_[e];
    lengths_[e] = {distance(original, a, b), distance(decoded, a, b)};
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

double RingEdgeDifference::temporal_part(std::span<const float> original,
                                         std::span<const float> decoded) {
  double sum = 0;
  for (std::uint32_t v = 0; v < num_vertices_; ++v) {
    const Vec3d step = minus(point_at(original, v), point_at(previous_original_, v));
    const Vec3d decoded_step = minus(point_at(decoded, v), point_at(previous_decoded_, v));
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

}  // namespace rlpc
