// Meshes without positions, for tests of connectivity and layers.
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "common/testing/grid.h"

namespace rlpc {

struct TriangleMesh {
  std::uint32_t num_vertices = 0;
  std::vector<Triangle> triangles;
};

// Returns the grid of grid_triangles().
inline TriangleMesh grid_mesh(std::uint32_t width, std::uint32_t height, bool closed) {
  return {width * height, grid_triangles(width, height, closed)};
}

// Numbers the vertices anew, at random.
inline void renumber_vertices(TriangleMesh& mesh, std::mt19937& random) {
  std::vector<std::uint32_t> place(mesh.num_vertices);
  for (std::uint32_t v = 0; v < mesh.num_vertices; ++v) place[v] = v;
  for (std::uint32_t v = mesh.num_vertices; v > 1; --v) {
    std::swap(place[v - 1], place[random() % v]);
  }
  for (Triangle& t : mesh.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
}

}  // namespace rlpc
