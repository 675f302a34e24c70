#include "encoder/codec/partition/kway.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "encoder/codec/partition/bisection.h"

namespace rlpc {
namespace {

constexpr int kGlobalPasses = 8;         // fixed: time; over all vertices
constexpr std::uint32_t kPerCent = 103;  // fixed: balance; largest part over the mean

void divide(const Graph& graph, const std::vector<std::uint32_t>& original, std::uint32_t first,
            std::uint32_t count, Partition& partition) {
  if (count == 1) {
    for (const std::uint32_t v : original) partition[v] = static_cast<std::uint16_t>(first);
    return;
  }
  const std::uint32_t half = count / 2;
  const Sides side = bisect(graph, half, count - half);
  for (std::uint8_t s = 0; s < 2; ++s) {
    Subgraph sub = subgraph(graph, side, s);
    for (std::uint32_t& v : sub.original) v = original[v];
    divide(sub.graph, sub.original, s == 0 ? first : first + half, s == 0 ? half : count - half,
           partition);
  }
}

// Moves vertices to the neighbouring part with most of their edges, as long as that cuts fewer
// edges, or as many between parts that are less equal.
class PartRefinement {
 public:
  PartRefinement(const Graph& graph, std::uint32_t count, Partition& partition)
      : graph_(graph), partition_(partition), size_(count), edges_(count) {
    for (const std::uint16_t part : partition) ++size_[part];
    const std::uint64_t n = partition.size();
    max_ = static_cast<std::uint32_t>(
        std::max<std::uint64_t>((n + count - 1) / count, n * kPerCent / (count * 100ULL)));
  }

  bool pass() {
    bool moved = false;
    for (std::uint32_t v = 0; v < partition_.size(); ++v) moved |= move(v);
    return moved;
  }

 private:
  bool move(std::uint32_t v) {
    const std::uint16_t from = partition_[v];
    if (size_[from] == 1) return false;
    near_.clear();
    for (std::uint32_t e = graph_.first[v]; e < graph_.first[v + 1]; ++e) {
      const std::uint16_t part = partition_[graph_.neighbour[e]];
      if (edges_[part] == 0) near_.push_back(part);
      edges_[part] += graph_.edge_weight[e];
    }
    std::uint16_t best = from;
    for (const std::uint16_t part : near_) {
      if (part == from || size_[part] >= max_) continue;
      const bool evens = size_[part] + 1 < (best == from ? size_[from] : size_[best] + 1);
      if (edges_[part] > edges_[best] || (edges_[part] == edges_[best] && evens)) best = part;
    }
    for (const std::uint16_t part : near_) edges_[part] = 0;
    if (best == from) return false;
    --size_[from];
    ++size_[best];
    partition_[v] = best;
    return true;
  }

  const Graph& graph_;
  Partition& partition_;
  std::vector<std::uint32_t> size_;   // [part]
  std::vector<std::uint64_t> edges_;  // [part]: edges of the vertex to it; 0 between calls
  std::vector<std::uint16_t> near_;   // parts that the vertex has edges to
  std::uint32_t max_ = 0;
};

}  // namespace

Partition kway_partition(const Graph& graph, std::uint32_t count) {
  Partition partition(graph.num_vertices());
  std::vector<std::uint32_t> all(graph.num_vertices());
  for (std::uint32_t v = 0; v < all.size(); ++v) all[v] = v;
  divide(graph, all, 0, count, partition);
  PartRefinement refinement(graph, count, partition);
  for (int i = 0; i < kGlobalPasses && refinement.pass(); ++i) {
  }
  return partition;
}

}  // namespace rlpc
