// Data for drawing a surface: coordinates, normals, edges. In floating point, for display only.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// The smallest box of the grid that holds all vertices.
struct FrameExtent {
  std::array<std::int32_t, 3> least{};
  std::array<std::int32_t, 3> most{};
};
// positions: [num_vertices][3], of at least one vertex.
FrameExtent extent_of(std::span<const std::int32_t> positions);

// Coordinates relative to the centre of the extent, which is 2 / 2^position_bits times as large
// as the grid: they are between -1 and 1, and the 24 bits of a float resolve the mesh, not its
// distance from the origin. positions and coordinates have the same size.
void centred_coordinates(std::span<const std::int32_t> positions, const FrameExtent& extent,
                         int position_bits, std::span<float> coordinates);

using Vec3f = std::array<float, 3>;

// The unit normal of each vertex: the mean of the normals of its triangles, weighted by area;
// the z axis for a vertex without triangles. Indices must be below num_vertices.
void vertex_normals(std::span<const float> coordinates, std::span<const Triangle> triangles,
                    std::vector<Vec3f>& normals);

// Vectors of length 1; the z axis for those without a direction. sums: [n][3].
void unit_normals(std::span<const double> sums, std::vector<Vec3f>& normals);

// The edges of the triangles, without duplicates.
std::vector<std::array<std::uint32_t, 2>> drawn_edges(std::span<const Triangle> triangles);

}  // namespace rlpc
