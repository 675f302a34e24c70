// 6.6 Vertex order, parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/memory/owned.h"
#include "common/result.h"

namespace rlpc {

// 6.6 vertex_order( ). Returns the output index of each decoded vertex: a permutation of
// 0 .. num_vertices - 1.
Result<Vector<std::uint32_t>> parse_vertex_order(BitReader& r, std::uint32_t num_vertices);

}  // namespace rlpc
