// Weighted graphs: the vertices of a mesh and its edges, and coarser versions of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rlpc {

struct GraphEdge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t weight = 1;
};

struct Graph {
  std::vector<std::uint32_t> first{0};     // [num_vertices + 1], into the arrays of edges
  std::vector<std::uint32_t> neighbour;    // ascending; every edge is listed at both ends
  std::vector<std::uint32_t> edge_weight;  // [neighbour.size()]
  std::vector<std::uint32_t> weight;       // [num_vertices]

  std::uint32_t num_vertices() const { return static_cast<std::uint32_t>(weight.size()); }
  std::span<const std::uint32_t> neighbours(std::uint32_t v) const {
    return std::span(neighbour).subspan(first[v], first[v + 1] - first[v]);
  }
};

// Makes a graph. weight: [num_vertices]. Edges between the same vertices become one with the
// sum of their weights; edges from a vertex to itself are dropped.
Graph make_graph(std::vector<std::uint32_t> weight, std::span<const GraphEdge> edges);

// The marked vertices and the edges between them. original: their numbers in `graph`.
struct Subgraph {
  Graph graph;
  std::vector<std::uint32_t> original;
};
Subgraph subgraph(const Graph& graph, std::span<const std::uint8_t> side, std::uint8_t marked);

}  // namespace rlpc
