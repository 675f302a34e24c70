// Coarser versions of a graph.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/codec/partition/graph.h"

namespace rlpc {

struct CoarseGraph {
  Graph graph;
  std::vector<std::uint32_t> coarse_of;  // [num_vertices of the finer graph]
};

// Merges pairs of vertices, neighbours along heavy edges first (Karypis and Kumar 1998), up to
// max_weight each. Vertices left over are paired if they have a common neighbour or none at
// all, so that every graph becomes smaller.
CoarseGraph coarsen(const Graph& fine, std::uint32_t max_weight);

}  // namespace rlpc
