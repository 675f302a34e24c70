#include "common/codec/mesh/topology.h"

#include <algorithm>
#include <compare>
#include <utility>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

// Groups (vertex, item) pairs by vertex, keeping their order within a vertex.
template <class T>
ListOfLists<T> group(std::uint32_t num_vertices,
                     const Vector<std::pair<std::uint32_t, T>>& pairs) {
  Vector<std::uint32_t> first(num_vertices + 1, 0);
  for (const auto& [vertex, item] : pairs) ++first[vertex + 1];
  for (std::size_t v = 0; v < num_vertices; ++v) first[v + 1] += first[v];
  Vector<std::uint32_t> next(first.begin(), first.end() - 1);
  Vector<T> items(pairs.size());
  for (const auto& [vertex, item] : pairs) items[next[vertex]++] = item;
  return {std::move(first), std::move(items)};
}

// Sorts (vertex, item) pairs by vertex with a counting sort, then the few items of each vertex.
template <class T>
void sort_pairs(std::uint32_t num_vertices, Vector<std::pair<std::uint32_t, T>>& pairs) {
  Vector<std::uint32_t> end(num_vertices + 1, 0);
  for (const auto& [vertex, item] : pairs) ++end[vertex + 1];
  for (std::size_t v = 0; v < num_vertices; ++v) end[v + 1] += end[v];
  Vector<std::pair<std::uint32_t, T>> by_vertex(pairs.size());
  for (const auto& pair : pairs) by_vertex[end[pair.first]++] = pair;
  std::uint32_t begin = 0;
  for (std::size_t v = 0; v < num_vertices; ++v) {
    std::sort(by_vertex.data() + begin, by_vertex.data() + end[v]);
    begin = end[v];
  }
  pairs = std::move(by_vertex);
}

// 8.3.1 Earlier neighbours
ListOfLists<std::uint32_t> find_earlier_neighbours(std::uint32_t num_vertices,
                                                   std::span<const Triangle> triangles) {
  Vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(triangles.size() * 3);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      if (low != high) pairs.emplace_back(high, low);
    }
  }
  sort_pairs(num_vertices, pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return group(num_vertices, pairs);
}

// Edge of a triangle: its higher vertex, and the vertex opposite to it.
struct EdgeOf {
  std::uint32_t high;
  std::uint32_t across;
  auto operator<=>(const EdgeOf&) const = default;
};

// 8.3.2 Parallelograms: only across edges of exactly two triangles
ListOfLists<Parallelogram> find_parallelograms(std::uint32_t num_vertices,
                                               std::span<const Triangle> triangles) {
  Vector<std::pair<std::uint32_t, EdgeOf>> edges;  // lower vertex, edge
  edges.reserve(triangles.size() * 3);
  for (const Triangle& t : triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[(k + 1) % 3], t[(k + 2) % 3]);
      edges.push_back({low, {high, t[k]}});
    }
  }
  sort_pairs(num_vertices, edges);
  Vector<std::pair<std::uint32_t, Parallelogram>> pairs;
  for (std::size_t i = 0; i < edges.size();) {
    const auto& [low, edge] = edges[i];
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].first == low &&
           edges[end].second.high == edge.high) {
      ++end;
    }
    if (end - i == 2) {
      const auto [opposite, predicted] = std::minmax(edge.across, edges[i + 1].second.across);
      if (predicted > edge.high && predicted > opposite) {
        pairs.emplace_back(predicted, Parallelogram{low, edge.high, opposite});
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
