// Matches the vertices of a decoded animation to those of the original.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "conformance/tools/comparison_input.h"

namespace rlpc {

// Per vertex of B its index in A. From the file that `rlpcenc --order-map` wrote, if `map_path`
// is not empty; otherwise the vertices are taken to be in the same order. In both cases the
// triangles must then be the same; where that proves nothing, because a stream is in the order
// of the connectivity process, in the same order as well.
InputResult<std::vector<std::uint32_t>> match_vertices(const ComparisonPair& pair,
                                                       const std::string& map_path);

}  // namespace rlpc
