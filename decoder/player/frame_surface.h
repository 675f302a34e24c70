// Data for drawing a surface: normals, edges, and distances from a reference. In floating
// point, for display only. Coordinates are [num_vertices][3], with magnitudes up to about 1.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mesh.h"

namespace rlpc {

// Unit normal of a vertex, times 32767; the fourth number is 0 and keeps 8 bytes per vertex.
using PackedNormal = std::array<std::int16_t, 4>;

// The normal of each vertex: the mean of the normals of its triangles, weighted by area; the z
// axis for a vertex without triangles. Indices must be below num_vertices.
void vertex_normals(std::span<const float> coordinates, std::span<const Triangle> triangles,
                    std::vector<PackedNormal>& normals);

// The edges of the triangles, without duplicates.
std::vector<std::array<std::uint32_t, 2>> drawn_edges(std::span<const Triangle> triangles);

struct Box {
  std::array<float, 3> least{};
  std::array<float, 3> most{};
};
// The bounding box of at least one vertex.
Box box_of(std::span<const float> coordinates);

struct Deviation {
  float largest = 0;
  float root_mean_square = 0;
};

// The distance of each vertex from the same vertex of a reference. shift: the origin of the
// coordinates minus that of the reference.
Deviation vertex_distances(std::span<const float> coordinates, std::span<const float> reference,
                           const std::array<double, 3>& shift, std::vector<float>& distances);

}  // namespace rlpc
