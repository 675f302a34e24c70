// Cuts triangles into an oriented pseudo-manifold: determines which edges are glued, and which
// corners are the same vertex instance (see 8.7.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/corners.h"
#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Half-edge 3 * t + k runs from corner k of triangle t to corner (k + 1) % 3; corner 3 * t + k
// and the half-edge that starts there share a number.
struct HalfEdges {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::vector<std::uint32_t> opposite;  // [half-edge]; kNone: mesh boundary
  std::vector<std::uint32_t> instance;  // [corner], 0 to num_instances - 1
  std::uint32_t num_instances = 0;
};

// Return the half-edge that starts at the same vertex, one triangle further around it; kNone at
// a mesh boundary. The two functions turn in opposite directions.
inline std::uint32_t turn_left(const HalfEdges& mesh, std::uint32_t h) {
  return mesh.opposite[previous_corner(h)];
}
inline std::uint32_t turn_right(const HalfEdges& mesh, std::uint32_t h) {
  const std::uint32_t opposite = mesh.opposite[h];
  return opposite == HalfEdges::kNone ? HalfEdges::kNone : next_corner(opposite);
}

// Glues half-edges a->b and b->a in pairs, in the order of their triangles; unpaired half-edges
// are boundary. Triangles must not be degenerate; indices must be below num_vertices, and there
// must be fewer than 2^32 / 3 triangles.
HalfEdges build_half_edges(std::uint32_t num_vertices, std::span<const Triangle> triangles);

}  // namespace rlpc
