// Which vertices of a mesh are near each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// [vertex]: the vertices that it shares a triangle with, ascending.
using VertexRings = std::vector<std::vector<std::uint32_t>>;
VertexRings vertex_rings(std::size_t num_vertices, std::span<const Triangle> triangles);

// Returns a vertex and those that are nearest to it along edges, at most `count` in all.
std::vector<std::uint32_t> vertices_around(const VertexRings& rings, std::uint32_t vertex,
                                           std::size_t count);

}  // namespace rlpc
