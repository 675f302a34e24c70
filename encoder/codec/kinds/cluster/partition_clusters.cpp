#include "encoder/codec/kinds/cluster/partition_clusters.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

constexpr std::size_t kCentral = 16;   // fixed: vertices whose triangles are compared
constexpr std::size_t kMaxTried = 64;  // fixed: time; then the part has no seed

std::vector<std::uint32_t> nearest_to_centre(const SpanFrames& frames,
                                             std::vector<std::uint32_t> vertices) {
  std::array<double, 3> centre{};
  for (const std::uint32_t v : vertices) {
    for (std::size_t c = 0; c < 3; ++c) centre[c] += frames.at(0, v)[c];
  }
  for (double& c : centre) c /= static_cast<double>(vertices.size());
  const std::size_t tried = std::min(kMaxTried, vertices.size());
  const auto end = vertices.begin() + static_cast<std::ptrdiff_t>(tried);
  std::partial_sort(vertices.begin(), end, vertices.end(),
                    [&](std::uint32_t a, std::uint32_t b) {
                      const double distance_a = distance2(frames.at(0, a), centre.data());
                      const double distance_b = distance2(frames.at(0, b), centre.data());
                      return distance_a != distance_b ? distance_a < distance_b : a < b;
                    });
  vertices.resize(tried);
  return vertices;
}

}  // namespace

PartitionClusters::PartitionClusters(PartitionMethod method, const SpanFrames& frames,
                                     std::span<const Triangle> triangles, int position_bits)
    : method_(method),
      frames_(frames),
      triangles_(triangles),
      choice_(frames, triangles, position_bits) {}

std::optional<Seed> PartitionClusters::seed_of(const std::vector<std::uint32_t>& vertices,
                                               const Partition& partition) const {
  const std::vector<std::uint32_t> central = nearest_to_centre(frames_, vertices);
  const std::uint16_t part = partition[central[0]];
  const SeedChoice::Suits is_within = [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](auto v) { return partition[v] == part; });
  };
  for (const SeedChoice::Suits& suits : {is_within, SeedChoice::Suits{}}) {
    std::optional<Seed> best;
    double quality = 0.0;
    for (std::size_t i = 0; i < central.size(); ++i) {
      if (best && i % kCentral == 0) break;  // vertices farther from the centre are not needed
      const auto seed = choice_.triangle_at(central[i], suits);
      if (!seed) continue;
      const double seed_quality = choice_.quality(*seed, quality);
      if (seed_quality <= quality) continue;
      quality = seed_quality;
      best = seed;
    }
    if (best) return best;
  }
  return std::nullopt;
}

Clustering PartitionClusters::make_clusters(std::uint32_t count) const {
  const Partition partition = partition_vertices(method_, frames_, triangles_, count);
  std::vector<std::vector<std::uint32_t>> vertices(num_parts(partition));
  for (std::uint32_t v = 0; v < partition.size(); ++v) vertices[partition[v]].push_back(v);
  std::vector<std::optional<Seed>> seeds(vertices.size());
  for_each(seeds.size(), [&](std::size_t i) { seeds[i] = seed_of(vertices[i], partition); });
  // Clusters without a seed come last.
  Clustering clustering;
  std::vector<std::uint16_t> cluster_of_part(seeds.size());
  std::uint16_t next = 0;
  for (const bool with_seed : {true, false}) {
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      if (seeds[i].has_value() != with_seed) continue;
      cluster_of_part[i] = next++;
      if (with_seed) clustering.seeds.push_back(*seeds[i]);
    }
  }
  clustering.without_lcf = seeds.size() - clustering.seeds.size();
  for (const std::uint16_t part : partition) {
    clustering.cluster_of_vertex.push_back(cluster_of_part[part]);
  }
  return clustering;
}

Clustering PartitionClusters::clusters(std::uint32_t count) {
  const auto known = known_.find(count);
  if (known != known_.end()) return known->second;
  return known_.emplace(count, make_clusters(count)).first->second;
}

Clustering PartitionClusters::spread_clusters(std::uint32_t count) {
  Clustering clustering = clusters(count);
  for_each(clustering.seeds.size(), [&](std::size_t i) {
    Seed& seed = clustering.seeds[i];
    seed = choice_.spread(seed, vertices_of(clustering, i), choice_.motion_in(seed));
  });
  return clustering;
}

}  // namespace rlpc
