#include "encoder/codec/kinds/skinned/fit/vertex_rings.h"

#include <algorithm>

#include "common/codec/mesh/indices.h"

namespace rlpc {

VertexRings vertex_rings(std::size_t num_vertices, std::span<const Triangle> triangles) {
  VertexRings rings(num_vertices);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      rings[t[k]].push_back(t[(k + 1) % 3]);
      rings[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  for (auto& ring : rings) sort_without_repetitions(ring);
  return rings;
}

std::vector<std::uint32_t> vertices_around(const VertexRings& rings, std::uint32_t vertex,
                                           std::size_t count) {
  std::vector<std::uint32_t> found{vertex};
  for (std::size_t i = 0; i < found.size() && found.size() < count; ++i) {
    for (const std::uint32_t v : rings[found[i]]) {
      if (found.size() == count) break;
      if (std::find(found.begin(), found.end(), v) == found.end()) found.push_back(v);
    }
  }
  return found;
}

}  // namespace rlpc
