// Meshes for the tests of metrics.
#pragma once

#include <cstdint>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

using Frame = std::vector<float>;

// A bumpy grid of side * side vertices, translated by `shift` and scaled by `scale`.
inline Frame sheet(std::uint32_t side, float shift, float scale) {
  Frame xyz;
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const float bump = (x * 7 + y * 3) % 4 == 0 ? 0.5F : 0.0F;
      for (const float c : {static_cast<float>(x) + shift, static_cast<float>(y), bump}) {
        xyz.push_back(scale * c);
      }
    }
  }
  return xyz;
}

inline std::vector<Triangle> sheet_triangles(std::uint32_t side) {
  std::vector<Triangle> triangles;
  for (std::uint32_t y = 0; y + 1 < side; ++y) {
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const std::uint32_t v = y * side + x;
      triangles.push_back({v, v + 1, v + side});
      triangles.push_back({v + 1, v + side + 1, v + side});
    }
  }
  return triangles;
}

}  // namespace rlpc
