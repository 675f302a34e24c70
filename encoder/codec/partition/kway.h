// Multilevel k-way graph partitioning (Karypis and Kumar 1998; Ramanathan, Kassim and Tan 2008,
// 2.1): parts of equal size, few edges between them.
//
// METIS does the same, but its random numbers and order of sums depend on version and build;
// partitions decide the encoder's bytes, which must be the same everywhere.
#pragma once

#include <cstdint>

#include "encoder/codec/partition/graph.h"
#include "encoder/codec/partition/partition.h"

namespace rlpc {

// Divides a graph by recursive bisection: each step coarsens the graph, divides the coarsest by
// its eigenvectors, and refines the division on the way back. In the end, vertices move between
// all parts.
//
//   graph  connected, vertices of weight 1
//   count  at most kMaxParts and the number of vertices
Partition kway_partition(const Graph& graph, std::uint32_t count);

}  // namespace rlpc
