// Data for drawing a surface: coordinates, normals and edges in floating point, for display
// only.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Smallest box of the grid that holds all vertices.
struct FrameExtent {
  std::array<std::int32_t, 3> min{};
  std::array<std::int32_t, 3> max{};
};
// Returns the extent. positions: [num_vertices][3], at least one vertex.
FrameExtent extent_of(std::span<const std::int32_t> positions);

// Computes coordinates between -1 and 1: positions relative to the centre of the extent, times
// 2 / 2^position_bits. The 24 bits of a float then resolve the mesh, not its distance from the
// origin. positions and coordinates have the same size.
void centred_coordinates(std::span<const std::int32_t> positions, const FrameExtent& extent,
                         int position_bits, std::span<float> coordinates);

using Vec3f = std::array<float, 3>;

// Computes the unit normal of each vertex: the mean of the normals of its triangles, weighted
// by area; the z axis for a vertex without triangles. Indices must be below num_vertices.
void vertex_normals(std::span<const float> coordinates, std::span<const Triangle> triangles,
                    std::vector<Vec3f>& normals);

// Computes unit vectors; the z axis for zero sums. sums: [n][3].
void unit_normals(std::span<const double> sums, std::vector<Vec3f>& normals);

// Returns the edges of the triangles, without duplicates.
std::vector<std::array<std::uint32_t, 2>> drawn_edges(std::span<const Triangle> triangles);

}  // namespace rlpc
