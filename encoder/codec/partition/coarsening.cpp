#include "encoder/codec/partition/coarsening.h"

#include <span>
#include <utility>

namespace rlpc {
namespace {

class Matching {
 public:
  Matching(const Graph& graph, std::uint32_t max_weight)
      : graph_(graph), max_weight_(max_weight), mate_(graph.num_vertices()) {
    for (std::uint32_t v = 0; v < mate_.size(); ++v) mate_[v] = v;
    for (std::uint32_t v = 0; v < mate_.size(); ++v) match_along_heaviest_edge(v);
    for (std::uint32_t v = 0; v < mate_.size(); ++v) match_all(graph_.neighbours(v));
    std::vector<std::uint32_t> lone;
    for (std::uint32_t v = 0; v < mate_.size(); ++v) {
      if (graph_.neighbours(v).empty()) lone.push_back(v);
    }
    match_all(lone);
  }
  const std::vector<std::uint32_t>& mate() const { return mate_; }  // itself: none

 private:
  bool is_free(std::uint32_t v) const { return mate_[v] == v; }
  bool suit(std::uint32_t a, std::uint32_t b) const {
    return std::uint64_t{graph_.weight[a]} + graph_.weight[b] <= max_weight_;
  }
  void match(std::uint32_t a, std::uint32_t b) {
    mate_[a] = b;
    mate_[b] = a;
  }

  // Matches along the heaviest edge; of equally heavy ones, that to the lightest vertex, so
  // that coarse vertices stay equally large.
  void match_along_heaviest_edge(std::uint32_t v) {
    if (!is_free(v)) return;
    std::uint32_t best = v;
    std::uint32_t heaviest = 0;
    for (std::uint32_t e = graph_.first[v]; e < graph_.first[v + 1]; ++e) {
      const std::uint32_t u = graph_.neighbour[e];
      if (!is_free(u) || !suit(v, u) || graph_.edge_weight[e] < heaviest) continue;
      const bool lighter = graph_.weight[u] < graph_.weight[best];
      if (best != v && graph_.edge_weight[e] == heaviest && !lighter) continue;
      best = u;
      heaviest = graph_.edge_weight[e];
    }
    if (best != v) match(v, best);
  }

  // Pairs vertices that have no mate.
  void match_all(std::span<const std::uint32_t> vertices) {
    const auto end = vertices.end();
    auto waiting = end;
    for (auto it = vertices.begin(); it != end; ++it) {
      if (!is_free(*it)) continue;
      if (waiting != end && suit(*waiting, *it)) {
        match(*waiting, *it);
        waiting = end;
      } else if (waiting == end || graph_.weight[*it] < graph_.weight[*waiting]) {
        waiting = it;
      }
    }
  }

  const Graph& graph_;
  std::uint32_t max_weight_;
  std::vector<std::uint32_t> mate_;
};

}  // namespace

CoarseGraph coarsen(const Graph& fine, std::uint32_t max_weight) {
  const Matching matching(fine, max_weight);
  CoarseGraph coarse;
  coarse.coarse_of.resize(fine.num_vertices());
  std::vector<std::uint32_t> weight;
  for (std::uint32_t v = 0; v < fine.num_vertices(); ++v) {
    const std::uint32_t mate = matching.mate()[v];
    if (mate < v) {
      coarse.coarse_of[v] = coarse.coarse_of[mate];
      continue;
    }
    coarse.coarse_of[v] = static_cast<std::uint32_t>(weight.size());
    weight.push_back(fine.weight[v] + (mate == v ? 0 : fine.weight[mate]));
  }
  std::vector<GraphEdge> edges;
  for (std::uint32_t v = 0; v < fine.num_vertices(); ++v) {
    for (std::uint32_t e = fine.first[v]; e < fine.first[v + 1]; ++e) {
      const std::uint32_t u = fine.neighbour[e];
      if (v > u) continue;  // an edge stands at both ends
      edges.push_back({coarse.coarse_of[v], coarse.coarse_of[u], fine.edge_weight[e]});
    }
  }
  coarse.graph = make_graph(std::move(weight), edges);
  return coarse;
}

}  // namespace rlpc
