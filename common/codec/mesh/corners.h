// Corners and edges of triangles, and pairs of edges of adjacent triangles (F.1, F.4).
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

// Corner 3 * t + k is corner k of triangle t; edge 3 * t + k begins there.
inline constexpr std::uint32_t kNoCorner = 0xFFFFFFFF;

// F.1 NextCorner( c ), PreviousCorner( c ) and VertexOfCorner( c )
constexpr std::uint32_t next_corner(std::uint32_t c) { return c % 3 == 2 ? c - 2 : c + 1; }
constexpr std::uint32_t previous_corner(std::uint32_t c) { return c % 3 == 0 ? c + 2 : c - 1; }
inline std::uint32_t vertex_of_corner(std::span<const Triangle> triangles, std::uint32_t c) {
  return triangles[c / 3][c % 3];
}

// F.4 FindEdgeMates( ): returns EdgeMate: for each edge, the opposite edge of another triangle;
// kNoCorner: none. Indices of vertices are below num_vertices.
Vector<std::uint32_t> find_edge_mates(std::uint32_t num_vertices,
                                      std::span<const Triangle> triangles);

}  // namespace rlpc
