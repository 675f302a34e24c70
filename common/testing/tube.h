// Mesh for tests that encode.
#pragma once

#include <cstdint>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Returns the triangles of a tube that is open at both ends; vertices are ordered by ring.
inline std::vector<Triangle> tube_triangles(std::uint32_t rings, std::uint32_t sides) {
  std::vector<Triangle> list;
  for (std::uint32_t r = 0; r + 1 < rings; ++r) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t a = r * sides + s;
      const std::uint32_t b = r * sides + (s + 1) % sides;
      list.push_back({a, b, a + sides});
      list.push_back({b, b + sides, a + sides});
    }
  }
  return list;
}

}  // namespace rlpc
