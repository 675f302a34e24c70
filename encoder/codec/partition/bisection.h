// Divides a graph in two.
#pragma once

#include <cstdint>

#include "encoder/codec/partition/bisection_refinement.h"
#include "encoder/codec/partition/graph.h"

namespace rlpc {

// Divides a graph, connected or not, in proportion to the numbers of parts that the two sides
// are to be divided into: few edges are cut, and each side has at least as many vertices as
// parts. All vertices have weight 1, and there are at least as many as parts.
Sides bisect(const Graph& graph, std::uint32_t parts0, std::uint32_t parts1);

}  // namespace rlpc
