#include "encoder/codec/metrics/sted.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "encoder/codec/metrics/points.h"

namespace rlpc {
namespace {

// The difference of two sums has rounding errors of about 1e-16 of them. Smaller shares of a
// variance count as 0, so that edges that change by the same ratio have no deviation.
constexpr double kRounding = 1e-14;

template <class Sums>
void add(Sums& to, const Sums& from, double times = 1) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += times * from[i];
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

StedSpatial::StedSpatial(std::uint32_t num_vertices, std::span<const Triangle> triangles)
    : num_vertices_(num_vertices),
      edges_(edges_of(triangles)),
      edge_sums_(edges_.size()),
      own_sums_(num_vertices),
      two_ring_sums_(num_vertices) {
  assert(num_vertices > 0);
  list_arcs();
}

void StedSpatial::list_arcs() {
  std::vector<std::size_t> valence(num_vertices_);
  for (const auto& edge : edges_) {
    for (const std::uint32_t v : edge) ++valence[v];
  }
  const auto starts_at = [&](const std::array<std::uint32_t, 2>& edge) {
    return valence[edge[1]] < valence[edge[0]] ? 1U : 0U;
  };
  first_arc_.assign(std::size_t{num_vertices_} + 1, 0);
  for (const auto& edge : edges_) ++first_arc_[std::size_t{edge[starts_at(edge)]} + 1];
  for (std::size_t v = 0; v < num_vertices_; ++v) first_arc_[v + 1] += first_arc_[v];
  arcs_.resize(edges_.size());
  std::vector<std::size_t> next(first_arc_.begin(), first_arc_.end() - 1);
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    const std::uint32_t start = starts_at(edges_[e]);
    arcs_[next[edges_[e][start]]++] = {edges_[e][1 - start], e};
  }
  for (std::size_t v = 0; v < num_vertices_; ++v) {
    std::sort(arcs_.begin() + static_cast<std::ptrdiff_t>(first_arc_[v]),
              arcs_.begin() + static_cast<std::ptrdiff_t>(first_arc_[v + 1]),
              [](const Arc& a, const Arc& b) { return a.to < b.to; });
  }
}

double StedSpatial::add_frame(std::span<const float> original, std::span<const float> decoded) {
  assert(original.size() == 3 * std::size_t{num_vertices_} &&
         decoded.size() == original.size());
  measure_edges(original, decoded);
  std::fill(own_sums_.begin(), own_sums_.end(), Sums{});
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    for (const std::uint32_t v : edges_[e]) add(own_sums_[v], edge_sums_[e]);
  }
  // The sums of all neighbours have each edge of the vertex itself once, and those between two
  // neighbours twice.
  std::fill(two_ring_sums_.begin(), two_ring_sums_.end(), Sums{});
  for (const auto& [a, b] : edges_) {
    add(two_ring_sums_[a], own_sums_[b]);
    add(two_ring_sums_[b], own_sums_[a]);
  }
  subtract_opposite_edges();
  double sum = 0;
  for (const auto& [weight, first, second] : two_ring_sums_) {
    if (weight <= 0) continue;
    const double mean = first / weight;
    const double variance = second / weight - mean * mean;
    if (variance > kRounding * second / weight) sum += std::sqrt(variance);
  }
  return sum / num_vertices_;
}

// Takes ed relative to its mean over all edges, so that nothing is lost where a vertex takes
// the difference of two sums, and the part is exactly 0 if all edges change by the same ratio.
void StedSpatial::measure_edges(std::span<const float> original,
                                std::span<const float> decoded) {
  double weight = 0;
  double mean = 0;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [a, b] = edges_[e];
    const double l = distance(original, a, b);
    const double ed = l > 0 ? (l - distance(decoded, a, b)) / l : 0;
    edge_sums_[e] = {l, ed, 0};
    weight += l;
    mean += l * ed;
  }
  if (weight > 0) mean /= weight;
  for (auto& [l, first, second] : edge_sums_) {
    const double d = first - mean;
    first = l * d;
    second = l * d * d;
  }
}

// Subtracts, for each cycle of three edges, from the sums of each vertex the edge opposite to
// it.
void StedSpatial::subtract_opposite_edges() {
  for (std::uint32_t u = 0; u < num_vertices_; ++u) {
    for (std::size_t i = first_arc_[u]; i < first_arc_[u + 1]; ++i) {
      const std::uint32_t v = arcs_[i].to;
      std::size_t j = first_arc_[u];
      std::size_t k = first_arc_[v];
      while (j < first_arc_[u + 1] && k < first_arc_[v + 1]) {
        const std::uint32_t w = arcs_[j].to;
        if (w < arcs_[k].to) {
          ++j;
        } else if (arcs_[k].to < w) {
          ++k;
        } else {
          add(two_ring_sums_[w], edge_sums_[arcs_[i].edge], -1);
          add(two_ring_sums_[v], edge_sums_[arcs_[j].edge], -1);
          add(two_ring_sums_[u], edge_sums_[arcs_[k].edge], -1);
          ++j;
          ++k;
        }
      }
    }
  }
}

void StedTemporal::add_frame(std::span<const float> original, std::span<const float> decoded) {
  assert(original.size() == 3 * std::size_t{num_vertices_} &&
         decoded.size() == original.size());
  if (previous_original_.empty()) {
    const double diagonal = box_diagonal(original);
    if (diagonal > 0) scale_ = 1 / diagonal;
  } else {
    std::vector<double> lengths(num_vertices_);
    std::vector<double> differences(num_vertices_);
    const auto length_of_step = [&](std::span<const float> to, std::span<const float> from,
                                    std::uint32_t v) {
      const double step = scale_ * length(minus(point_at(to, v), point_at(from, v)));
      return std::sqrt(step * step + kDt * kDt);
    };
    for (std::uint32_t v = 0; v < num_vertices_; ++v) {
      lengths[v] = length_of_step(original, previous_original_, v);
      differences[v] = std::abs(lengths[v] - length_of_step(decoded, previous_decoded_, v));
    }
    lengths_.push_back(std::move(lengths));
    differences_.push_back(std::move(differences));
    if (lengths_.size() > kStepsBefore + 1 + kStepsAfter) lengths_.pop_front();
    ++num_steps_;
    if (differences_.size() > kStepsAfter) {
      parts_.push_back(part_of(parts_.size()));
      differences_.pop_front();
    }
  }
  previous_original_.assign(original.begin(), original.end());
  previous_decoded_.assign(decoded.begin(), decoded.end());
}

// Returns the part of a step that differences_ has.
double StedTemporal::part_of(std::size_t step) const {
  const std::size_t first_kept = num_steps_ - lengths_.size();
  const std::size_t begin = step < kStepsBefore ? 0 : step - kStepsBefore;
  const std::size_t end = std::min(step + kStepsAfter + 1, num_steps_);
  assert(begin >= first_kept && step >= parts_.size());
  const std::vector<double>& differences = differences_[step - parts_.size()];
  double sum = 0;
  for (std::uint32_t v = 0; v < num_vertices_; ++v) {
    double mean = 0;
    for (std::size_t i = begin; i < end; ++i) mean += lengths_[i - first_kept][v];
    sum += differences[v] * static_cast<double>(end - begin) / mean;
  }
  return sum / num_vertices_;
}

std::vector<double> StedTemporal::steps() const {
  std::vector<double> all = parts_;
  while (all.size() < num_steps_) all.push_back(part_of(all.size()));
  return all;
}

}  // namespace rlpc
