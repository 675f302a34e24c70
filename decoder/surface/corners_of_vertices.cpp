#include "decoder/surface/corners_of_vertices.h"

#include <numeric>

namespace rlpc {

CornersOfVertices::CornersOfVertices(std::span<const Triangle> triangles,
                                     std::uint32_t num_vertices)
    : begin(std::size_t{num_vertices} + 1), corners(3 * triangles.size()) {
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) ++begin[v + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  Vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    corners[next[triangles[c / 3][c % 3]]++] = c;
  }
}

}  // namespace rlpc
