#include "encoder/codec/partition/graph.h"

#include <algorithm>
#include <utility>

namespace rlpc {

Graph make_graph(std::vector<std::uint32_t> weight, std::span<const GraphEdge> edges) {
  Graph graph;
  graph.weight = std::move(weight);
  const std::size_t n = graph.weight.size();
  std::vector<std::uint32_t> first(n + 1, 0);
  for (const GraphEdge& e : edges) {
    if (e.a == e.b) continue;
    ++first[e.a + 1];
    ++first[e.b + 1];
  }
  for (std::size_t v = 0; v < n; ++v) first[v + 1] += first[v];
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends(first[n]);  // neighbour, weight
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const GraphEdge& e : edges) {
    if (e.a == e.b) continue;
    ends[next[e.a]++] = {e.b, e.weight};
    ends[next[e.b]++] = {e.a, e.weight};
  }
  for (std::size_t v = 0; v < n; ++v) {
    const auto begin = ends.begin() + first[v];
    const auto end = ends.begin() + first[v + 1];
    std::sort(begin, end);
    for (auto it = begin; it != end; ++it) {
      if (graph.neighbour.size() > graph.first.back() && graph.neighbour.back() == it->first) {
        graph.edge_weight.back() += it->second;
        continue;
      }
      graph.neighbour.push_back(it->first);
      graph.edge_weight.push_back(it->second);
    }
    graph.first.push_back(static_cast<std::uint32_t>(graph.neighbour.size()));
  }
  return graph;
}

Subgraph subgraph(const Graph& graph, std::span<const std::uint8_t> side, std::uint8_t marked) {
  Subgraph sub;
  std::vector<std::uint32_t> number(graph.num_vertices());
  for (std::uint32_t v = 0; v < graph.num_vertices(); ++v) {
    if (side[v] != marked) continue;
    number[v] = static_cast<std::uint32_t>(sub.original.size());
    sub.original.push_back(v);
  }
  for (const std::uint32_t v : sub.original) {
    sub.graph.weight.push_back(graph.weight[v]);
    for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
      if (side[graph.neighbour[e]] != marked) continue;
      sub.graph.neighbour.push_back(number[graph.neighbour[e]]);
      sub.graph.edge_weight.push_back(graph.edge_weight[e]);
    }
    sub.graph.first.push_back(static_cast<std::uint32_t>(sub.graph.neighbour.size()));
  }
  return sub;
}

}  // namespace rlpc
