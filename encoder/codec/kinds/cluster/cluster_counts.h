// The numbers of clusters that searches compare, and the way from one to the next.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "encoder/codec/spans/count_at.h"

namespace rlpc {

// Returns the place in the series count_at() of the last number, below `end`, that leaves
// vertices besides those of seeds.
inline std::size_t last_cluster_count(std::uint32_t num_vertices, std::size_t end) {
  constexpr std::uint32_t kSeedVertices = 3;  // fixed: number per cluster
  std::size_t last = 0;
  while (last + 1 < end && count_at(last + 1) * kSeedVertices < num_vertices) ++last;
  return last;
}

// Climbs from a place while the cost falls, up or else down. Returns the best place, at most
// `last`.
//
//   stride   places from one to the next
//   cost_at  cost of a place; called once for each that is compared
template <typename CostAt>
std::size_t climb(std::size_t start, std::size_t last, std::size_t stride,
                  const CostAt& cost_at) {
  start = std::min(last, start);
  std::size_t best = start;
  double lowest_cost = cost_at(best);
  for (const bool up : {true, false}) {
    if (best != start) break;
    for (std::size_t i = best; up ? i + stride <= last : i >= stride;) {
      i = up ? i + stride : i - stride;
      const double cost = cost_at(i);
      if (cost >= lowest_cost) break;
      lowest_cost = cost;
      best = i;
    }
  }
  return best;
}

}  // namespace rlpc
