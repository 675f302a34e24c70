// Which vertex of a decoded animation is which of the original.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "conformance/tools/comparison_input.h"

namespace rlpc {

// Per vertex of B its index in A. From the file that `rlpcenc --order-map` wrote, if `map_path`
// is not empty; else the vertices stand in the same order. Either way the triangles of both
// must then be the same. Where they cannot tell, because a stream is in the order of the
// connectivity process, they must be the same list.
InputResult<std::vector<std::uint32_t>> match_vertices(const ComparisonPair& pair,
                                                       const std::string& map_path);

}  // namespace rlpc
