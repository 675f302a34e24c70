// What a surface needs besides positions to be drawn: normals, edges, distances between two.
// Floating point, for the eye only. Coordinates, [num_vertices][3], are up to about 1 in size.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mesh.h"

namespace rlpc {

// Unit normal of a vertex, times 32767; the fourth number is 0 and keeps 8 bytes per vertex.
using PackedNormal = std::array<std::int16_t, 4>;

// Means of the normals of the triangles around each vertex, weighted by area; of a vertex
// without any, the z axis. Indices are below num_vertices.
void vertex_normals(std::span<const float> coordinates, std::span<const Triangle> triangles,
                    std::vector<PackedNormal>& normals);

// Each edge of the triangles once.
std::vector<std::array<std::uint32_t, 2>> drawn_edges(std::span<const Triangle> triangles);

struct Box {
  std::array<float, 3> least{};
  std::array<float, 3> most{};
};
// Of at least one vertex.
Box box_of(std::span<const float> coordinates);

struct Deviation {
  float largest = 0;
  float root_mean_square = 0;
};

// Distance of each vertex from the same one of a reference. `shift`: of the place that the
// coordinates count from, against that of the reference.
Deviation vertex_distances(std::span<const float> coordinates, std::span<const float> reference,
                           const std::array<double, 3>& shift, std::vector<float>& distances);

}  // namespace rlpc
