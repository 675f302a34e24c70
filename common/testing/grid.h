// Mesh for tests of layers.
#pragma once

#include <cstdint>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Returns the triangles of a grid of squares; vertices are ordered by row. closed: the grid
// wraps in both directions to a torus.
inline std::vector<Triangle> grid_triangles(std::uint32_t width, std::uint32_t height,
                                            bool closed) {
  std::vector<Triangle> triangles;
  for (std::uint32_t y = 0; y < height - (closed ? 0 : 1); ++y) {
    for (std::uint32_t x = 0; x < width - (closed ? 0 : 1); ++x) {
      const std::uint32_t row = y * width;
      const std::uint32_t above = (y + 1) % height * width;
      const std::uint32_t right = (x + 1) % width;
      triangles.push_back({row + x, row + right, above + right});
      triangles.push_back({row + x, above + right, above + x});
    }
  }
  return triangles;
}

}  // namespace rlpc
