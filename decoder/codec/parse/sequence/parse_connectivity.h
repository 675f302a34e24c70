// 6.4 Connectivity, parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"
#include "common/result.h"

namespace rlpc {

// 6.4.1 connectivity( ): returns the triangles in decoding order, every index below
// num_vertices.
//
// `r` covers exactly the payload of the unit. The caller has checked num_vertices and
// num_triangles against its limits. Memory grows with the decoded triangles, not with the
// header; time is linear in the payload and the decoded triangles.
Result<Vector<Triangle>> parse_connectivity(BitReader& r, std::uint32_t num_vertices,
                                            std::uint32_t num_triangles);

}  // namespace rlpc
