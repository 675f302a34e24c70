#include "encoder/codec/partition/mesh_graph.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rlpc {
namespace {

constexpr std::size_t kNeighbours = 6;  // fixed: neighbours in a regular mesh

std::vector<GraphEdge> mesh_edges(std::span<const Triangle> triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) pairs.push_back(std::minmax({t[k], t[(k + 1) % 3]}));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<GraphEdge> edges;
  edges.reserve(pairs.size());
  for (const auto& [a, b] : pairs) edges.push_back({a, b, kMeshEdge});
  return edges;
}

// Returns the vertices of each component, in the order of lowest vertices.
std::vector<std::vector<std::uint32_t>> components(std::size_t num_vertices,
                                                   std::span<const GraphEdge> edges) {
  std::vector<std::uint32_t> lower(num_vertices);  // in the same component; the lowest: itself
  std::iota(lower.begin(), lower.end(), 0U);
  const auto lowest = [&](std::uint32_t v) {
    while (lower[v] != v) v = lower[v] = lower[lower[v]];
    return v;
  };
  for (const GraphEdge& e : edges) {
    const auto [low, high] = std::minmax({lowest(e.a), lowest(e.b)});
    lower[high] = low;
  }
  std::vector<std::uint32_t> number(num_vertices);
  std::vector<std::vector<std::uint32_t>> found;
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    const std::uint32_t root = lowest(v);
    if (root == v) {
      number[v] = static_cast<std::uint32_t>(found.size());
      found.emplace_back();
    }
    found[number[root]].push_back(v);
  }
  return found;
}

Point3 centre(std::span<const Point3> points, std::span<const std::uint32_t> vertices) {
  Point3 mean{};
  for (const std::uint32_t v : vertices) {
    for (std::size_t c = 0; c < 3; ++c) mean[c] += points[v][c];
  }
  for (double& c : mean) c /= static_cast<double>(vertices.size());
  return mean;
}

std::uint32_t nearest_to(const Point3& place, std::span<const Point3> points,
                         std::span<const std::uint32_t> vertices) {
  return *std::min_element(vertices.begin(), vertices.end(), [&](auto a, auto b) {
    return squared_distance(points[a], place) < squared_distance(points[b], place);
  });
}

}  // namespace

Graph make_mesh_graph(std::span<const Point3> points, std::span<const Triangle> triangles) {
  std::vector<GraphEdge> edges = mesh_edges(triangles);
  // Each round at least halves the number of components.
  for (;;) {
    const auto parts = components(points.size(), edges);
    if (parts.size() <= 1) break;
    std::vector<Point3> centres;
    centres.reserve(parts.size());
    for (const auto& vertices : parts) centres.push_back(centre(points, vertices));
    const PointTree tree(centres);
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      for (const std::uint32_t j : tree.nearest(i, kNeighbours)) {
        edges.push_back({nearest_to(centres[j], points, parts[i]),
                         nearest_to(centres[i], points, parts[j]), kLink});
      }
    }
  }
  return make_graph(std::vector<std::uint32_t>(points.size(), 1), edges);
}

}  // namespace rlpc
