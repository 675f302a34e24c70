#include "common/topology.h"

#include <algorithm>
#include <array>
#include <utility>

namespace rlpc {
namespace {

// Groups (vertex, item) pairs by vertex, keeping their order within a vertex.
template <class T>
ListOfLists<T> group(std::uint32_t num_vertices,
                     const std::vector<std::pair<std::uint32_t, T>>& pairs) {
  std::vector<std::uint32_t> first(num_vertices + 1, 0);
  for (const auto& [vertex, item] : pairs) ++first[vertex + 1];
  for (std::size_t v = 0; v < num_vertices; ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  std::vector<T> items(pairs.size());
  for (const auto& [vertex, item] : pairs) items[next[vertex]++] = item;
  return {std::move(first), std::move(items)};
}

// 8.3.1 Earlier neighbours
ListOfLists<std::uint32_t> find_earlier_neighbours(std::uint32_t num_vertices,
                                                   std::span<const Triangle> triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(triangles.size() * 3);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      if (low != high) pairs.emplace_back(high, low);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return group(num_vertices, pairs);
}

// A directed edge of a triangle and the vertex across.
struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t across;
};

// 8.3.2 Parallelograms: only across edges of exactly two triangles.
ListOfLists<Parallelogram> find_parallelograms(std::uint32_t num_vertices,
                                               std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(triangles.size() * 3);
  for (const Triangle& t : triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[(k + 1) % 3], t[(k + 2) % 3]);
      edges.push_back({low, high, t[k]});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return std::array{x.low, x.high, x.across} < std::array{y.low, y.high, y.across};
  });
  std::vector<std::pair<std::uint32_t, Parallelogram>> pairs;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low &&
           edges[end].high == edges[i].high) {
      ++end;
    }
    if (end - i == 2) {
      const std::uint32_t predicted = std::max(edges[i].across, edges[i + 1].across);
      const std::uint32_t opposite = std::min(edges[i].across, edges[i + 1].across);
      if (predicted > edges[i].high && predicted > opposite) {
        pairs.emplace_back(predicted, Parallelogram{edges[i].low, edges[i].high, opposite});
      }
    }
    i = end;
  }
  return group(num_vertices, pairs);
}

}  // namespace

Topology make_topology(std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  return {find_earlier_neighbours(num_vertices, triangles),
          find_parallelograms(num_vertices, triangles)};
}

}  // namespace rlpc
