// Matches the vertices of a decoded animation to those of the original.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "conformance/rlpccmp/comparison_input.h"

namespace rlpc {

// Returns the index in A of each vertex of B: from the file that `rlpcenc --order-map` wrote,
// if `map_path` is not empty; otherwise both are assumed to have the same order. Either way,
// the triangles must then be the same. If there is no map and one side is a stream, whose
// vertices are in the order of the connectivity process, the triangles must also be in the same
// order, because the same set of triangles would prove nothing.
InputResult<std::vector<std::uint32_t>> match_vertices(const ComparisonPair& pair,
                                                       const std::string& map_path);

}  // namespace rlpc
