// Refines a division of a graph in two (Kernighan and Lin 1970, Fiduccia and Mattheyses 1982).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/codec/partition/graph.h"

namespace rlpc {

using Sides = std::vector<std::uint8_t>;  // [vertex], 0 or 1
using SideWeights = std::array<std::int64_t, 2>;

// Moves vertices one by one, even if that cuts more edges at first, and keeps the moves up to
// the best state: the least weight of a side above `max_weights`, then the least weight of cut
// edges. Repeats this while it helps.
void refine_bisection(const Graph& graph, const SideWeights& max_weights, Sides& side);

// Returns the weight of edges between sides, or between parts.
template <typename Part>
std::int64_t cut_weight(const Graph& graph, const std::vector<Part>& part) {
  std::int64_t cut = 0;
  for (std::uint32_t v = 0; v < graph.num_vertices(); ++v) {
    for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
      const std::uint32_t u = graph.neighbour[e];
      if (v < u && part[v] != part[u]) cut += graph.edge_weight[e];
    }
  }
  return cut;
}

}  // namespace rlpc
