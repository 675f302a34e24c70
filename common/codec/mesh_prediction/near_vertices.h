// 8.19.2: the vertices near another one in a decoded frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/mesh/ordered_mesh.h"

namespace rlpc {

// With a ring of 7 and 5 earlier errors, three vectors of a filter are full. Half: +9.7 % on
// average, robot +16 %; 16: -1.7 %, for a third more time; 20, all that a filter has room for:
// -1.9 %, for two fifths (measured as in near_vertices.cpp).
inline constexpr std::size_t kMaxNear = 12;

// NearVertices( v ) of all vertices: of those in the outer ring, and in the rings and outer
// rings of the ring, the nearest that are not in the ring; vertices of the base are candidates,
// too, for those in the base, and for those with few others. All come before v in the order.
//
//   values  positions [num_vertices][3], within 29 bits
VertexLists near_vertices(const OrderedMesh& mesh, std::span<const std::int32_t> values);

}  // namespace rlpc
