// 8.19.2: vertices near a vertex in a decoded frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/mesh/ordered_mesh.h"

namespace rlpc {

// Maximum number of near vertices. With a ring of 7 and 5 earlier errors, it fills three
// vectors of a filter. Half: +9.7 % on average, robot +16 %; 16: -1.7 %, for a third more time;
// 20, the maximum of a filter: -1.9 %, for two fifths (measured as in near_vertices.cpp).
inline constexpr std::size_t kMaxNear = 12;

// Returns NearVertices( v ) of all vertices: the nearest vertices outside the ring from the
// outer ring and the rings and outer rings of the ring, and from the base if v is in the base
// or has few others. All precede v in the order.
//
//   values  positions [num_vertices][3], within 29 bits
VertexLists near_vertices(const OrderedMesh& mesh, std::span<const std::int32_t> values);

}  // namespace rlpc
