#include "common/codec/mesh/corners.h"

#include <algorithm>
#include <numeric>

#include "common/memory/owned.h"

namespace rlpc {

// F.4 FindEdgeMates( )
Vector<std::uint32_t> find_edge_mates(std::uint32_t num_vertices,
                                      std::span<const Triangle> triangles) {
  const auto is_regular = [](const Triangle& t) {
    return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
  };
  // Groups the edges by their lower vertex, in two passes.
  Vector<std::uint32_t> first(num_vertices + std::size_t{1}, 0);
  for (const Triangle& t : triangles) {
    if (!is_regular(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) ++first[std::min(t[k], t[(k + 1) % 3]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  Vector<std::uint32_t> edges(first.back());
  Vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (!is_regular(triangles[t])) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      edges[next[std::min(triangles[t][k], triangles[t][(k + 1) % 3])]++] = 3 * t + k;
    }
  }
  // First two edges, and number of edges, from the current lower vertex to a higher one.
  struct Across {
    std::array<std::uint32_t, 2> edges{};
    std::uint32_t count = 0;
  };
  Vector<Across> across(num_vertices);
  Vector<std::uint32_t> mates(3 * triangles.size(), kNoCorner);
  for (std::uint32_t low = 0; low < num_vertices; ++low) {
    const auto low_edges = std::span(edges).subspan(first[low], first[low + 1] - first[low]);
    const auto begin_of = [&](std::uint32_t edge) { return vertex_of_corner(triangles, edge); };
    const auto high_of = [&](std::uint32_t edge) {
      return begin_of(edge) == low ? begin_of(next_corner(edge)) : begin_of(edge);
    };
    for (const std::uint32_t edge : low_edges) {
      Across& x = across[high_of(edge)];
      if (x.count < 2) x.edges[x.count] = edge;
      ++x.count;
    }
    for (const std::uint32_t edge : low_edges) {
      Across& x = across[high_of(edge)];
      if (x.count == 2 && begin_of(x.edges[0]) != begin_of(x.edges[1])) {
        mates[x.edges[0]] = x.edges[1];
        mates[x.edges[1]] = x.edges[0];
      }
      x.count = 0;
    }
  }
  return mates;
}

}  // namespace rlpc
