#include "encoder/codec/partition/bisection_refinement.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

namespace rlpc {
namespace {

constexpr int kPasses = 8;          // fixed: time; they rarely help after four
constexpr std::size_t kTried = 16;  // fixed: time; vertices that may be too heavy for a side
constexpr std::size_t kPatience = 100;  // fixed: time; moves of a pass without success

class RefinementPass {
 public:
  RefinementPass(const Graph& graph, const SideWeights& max_weights, Sides& side)
      : graph_(graph),
        max_(max_weights),
        side_(side),
        gain_(graph.num_vertices()),
        is_locked_(graph.num_vertices()) {
    for (std::uint32_t v = 0; v < graph.num_vertices(); ++v) {
      weight_[side[v]] += graph.weight[v];
      bool may_move = graph.neighbours(v).empty();
      for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
        const bool is_cut = side[graph.neighbour[e]] != side[v];
        gain_[v] += is_cut ? graph.edge_weight[e] : -std::int64_t{graph.edge_weight[e]};
        if (is_cut) may_move = true;
      }
      if (may_move) queue_[side[v]].emplace(-gain_[v], v);
    }
  }

  // Runs a pass. Returns whether anything got better.
  bool run() {
    const State start{excess(), 0};
    State best = start;
    std::size_t best_moves = 0;
    std::int64_t saved = 0;
    while (moved_.size() < best_moves + kPatience) {
      const auto v = next();
      if (!v) break;
      saved += gain_[*v];
      move(*v);
      moved_.push_back(*v);
      const State now{excess(), -saved};
      if (now < best) {
        best = now;
        best_moves = moved_.size();
      }
    }
    for (std::size_t i = best_moves; i < moved_.size(); ++i) side_[moved_[i]] ^= 1;
    return best < start;
  }

 private:
  using State = std::pair<std::int64_t, std::int64_t>;  // excess, cut beyond the first
  using Entry = std::pair<std::int64_t, std::uint32_t>;

  std::int64_t excess() const {
    return std::max<std::int64_t>(weight_[0] - max_[0], 0) +
           std::max<std::int64_t>(weight_[1] - max_[1], 0);
  }

  std::optional<std::uint32_t> next() {
    for (const std::size_t s : {0U, 1U}) {
      if (weight_[s] <= max_[s]) continue;
      if (queue_[s].empty()) queue_all(s);
      return queue_[s].empty() ? std::nullopt : std::optional(queue_[s].begin()->second);
    }
    const auto vertex_0 = first_that_fits(0);
    const auto vertex_1 = first_that_fits(1);
    if (!vertex_0 && !vertex_1) return std::nullopt;
    if (!vertex_0 || !vertex_1) return (vertex_0 ? vertex_0 : vertex_1)->second;
    return std::min(*vertex_0, *vertex_1).second;
  }

  // Returns the best vertex of a side that the other side has room for.
  std::optional<Entry> first_that_fits(std::size_t s) const {
    std::size_t tried = 0;
    for (const Entry& entry : queue_[s]) {
      if (weight_[1 - s] + graph_.weight[entry.second] <= max_[1 - s]) return entry;
      if (++tried == kTried) break;
    }
    return std::nullopt;
  }

  // Queues all vertices of a side: if no edge is cut, any vertex may have to move.
  void queue_all(std::size_t s) {
    for (std::uint32_t v = 0; v < graph_.num_vertices(); ++v) {
      if (side_[v] == s && !is_locked_[v]) queue_[s].emplace(-gain_[v], v);
    }
  }

  void move(std::uint32_t v) {
    const std::uint8_t from = side_[v];
    queue_[from].erase({-gain_[v], v});
    is_locked_[v] = true;
    weight_[from] -= graph_.weight[v];
    side_[v] ^= 1;
    weight_[side_[v]] += graph_.weight[v];
    for (std::uint32_t e = graph_.first[v]; e < graph_.first[v + 1]; ++e) {
      const std::uint32_t u = graph_.neighbour[e];
      const std::int64_t change = 2 * std::int64_t{graph_.edge_weight[e]};
      if (!is_locked_[u]) queue_[side_[u]].erase({-gain_[u], u});
      gain_[u] += side_[u] == from ? change : -change;
      if (!is_locked_[u]) queue_[side_[u]].emplace(-gain_[u], u);
    }
  }

  const Graph& graph_;
  const SideWeights& max_;
  Sides& side_;
  std::vector<std::int64_t> gain_;  // cut weight that moving the vertex saves
  std::vector<bool> is_locked_;     // has moved
  SideWeights weight_{};
  std::array<std::set<Entry>, 2>
      queue_;  // [side]: vertices at the cut, or without edges; best gain first
  std::vector<std::uint32_t> moved_;
};

}  // namespace

void refine_bisection(const Graph& graph, const SideWeights& max_weights, Sides& side) {
  for (int i = 0; i < kPasses; ++i) {
    if (!RefinementPass(graph, max_weights, side).run()) return;
  }
}

}  // namespace rlpc
