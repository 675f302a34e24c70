#include "encoder/codec/kinds/cluster/clustering.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/parallel/for_each.h"

namespace rlpc {

std::vector<std::uint32_t> vertices_of(const Clustering& clustering, std::size_t cluster) {
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t v = 0; v < clustering.cluster_of_vertex.size(); ++v) {
    if (clustering.cluster_of_vertex[v] == cluster) vertices.push_back(v);
  }
  return vertices;
}

MotionClusters::MotionClusters(const SpanFrames& frames, std::span<const Triangle> triangles,
                               int position_bits, const SeedRules& rules)
    : frames_(frames),
      choice_(frames, triangles, position_bits, rules),
      distance_(frames.num_vertices) {
  const std::uint32_t n = frames.num_vertices;
  std::array<double, 3> centre{};
  for (std::uint32_t v = 0; v < n; ++v) {
    for (std::size_t c = 0; c < 3; ++c) centre[c] += frames.at(0, v)[c];
  }
  for (double& c : centre) c /= n;
  for (std::uint32_t v = 0; v < n; ++v) {
    distance_[v] = choice_.is_isolated(v) ? -1.0 : distance2(frames.at(0, v), centre.data());
  }
}

// Adds a seed. Returns false once every vertex is a seed or was skipped.
bool MotionClusters::add_seed() {
  for (;;) {
    const auto farthest = std::max_element(distance_.begin(), distance_.end());
    if (*farthest < 0.0) return false;
    const auto v = static_cast<std::uint32_t>(farthest - distance_.begin());
    *farthest = -1.0;
    const auto seed = choice_.triangle_at(v);
    if (!seed) continue;
    if (seeds_.empty()) {
      for (double& d : distance_) d = d < 0.0 ? d : std::numeric_limits<double>::infinity();
    }
    for (std::uint32_t u = 0; u < frames_.num_vertices; ++u) {
      distance_[u] = std::min(distance_[u], distance2(frames_.at(0, u), frames_.at(0, v)));
    }
    seeds_.push_back(*seed);
    return true;
  }
}

Clustering MotionClusters::clusters(std::uint32_t count) {
  const std::size_t before = seeds_.size();
  while (seeds_.size() < count && add_seed()) {
  }
  motion_.resize(seeds_.size());
  for_each(seeds_.size() - before,
           [&](std::size_t i) { motion_[before + i] = choice_.motion_in(seeds_[before + i]); });
  const std::size_t found = std::min<std::size_t>(seeds_.size(), count);
  Clustering clustering;
  clustering.seeds.assign(seeds_.begin(), seeds_.begin() + static_cast<std::ptrdiff_t>(found));
  clustering.cluster_of_vertex.assign(frames_.num_vertices, 0);
  std::vector<double> min_motion(frames_.num_vertices, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < found; ++i) assign(clustering, i, motion_[i], min_motion);
  return clustering;
}

// Assigns to cluster i the vertices that move less in its coordinates than in those of clusters
// 0 to i - 1.
void MotionClusters::assign(Clustering& clustering, std::size_t i,
                            const std::vector<double>& motion,
                            std::vector<double>& min_motion) {
  for (std::uint32_t v = 0; v < motion.size(); ++v) {
    if (motion[v] >= min_motion[v]) continue;
    min_motion[v] = motion[v];
    clustering.cluster_of_vertex[v] = static_cast<std::uint16_t>(i);
  }
}

Clustering MotionClusters::spread_clusters(std::uint32_t count) {
  Clustering clustering = clusters(count);
  constexpr std::size_t kTogether = 16;  // fixed: memory
  const Clustering before = clustering;
  std::vector<double> min_motion(frames_.num_vertices, std::numeric_limits<double>::infinity());
  for (std::size_t first = 0; first < before.seeds.size(); first += kTogether) {
    std::vector<std::vector<double>> motion(std::min(kTogether, before.seeds.size() - first));
    for_each(motion.size(), [&](std::size_t i) {
      const std::size_t at = first + i;
      clustering.seeds[at] =
          choice_.spread(before.seeds[at], vertices_of(before, at), motion_[at]);
      motion[i] = choice_.motion_in(clustering.seeds[at]);
    });
    for (std::size_t i = 0; i < motion.size(); ++i) {
      assign(clustering, first + i, motion[i], min_motion);
    }
  }
  return clustering;
}

}  // namespace rlpc
