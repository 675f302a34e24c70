// The corners of the triangles at each vertex.
#pragma once

#include <cstdint>
#include <span>

#include "common/mesh/mesh.h"
#include "common/owned.h"

namespace rlpc {

struct CornersOfVertices {
  Vector<std::uint32_t> begin;    // [vertex], and one more: index of its first corner below
  Vector<std::uint32_t> corners;  // 3 * t + k, ascending for each vertex

  CornersOfVertices() = default;
  CornersOfVertices(std::span<const Triangle> triangles, std::uint32_t num_vertices);

  std::span<const std::uint32_t> of(std::uint32_t v) const {
    return std::span(corners).subspan(begin[v], begin[v + 1] - begin[v]);
  }
  std::span<std::uint32_t> of(std::uint32_t v) {
    return std::span(corners).subspan(begin[v], begin[v + 1] - begin[v]);
  }
};

}  // namespace rlpc
