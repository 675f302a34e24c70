#include "encoder/codec/partition/bisection.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "encoder/codec/math/eigenvectors.h"
#include "encoder/codec/partition/coarsening.h"

namespace rlpc {
namespace {

constexpr std::int64_t kCoarsest = 96;  // fixed: time of the eigenvectors
constexpr std::size_t kVectors = 2;     // fixed: time; each gives two divisions
constexpr std::int64_t kSlack = 100;    // fixed: balance; a side may exceed its share by 1 %
// fixed: to end. Coarsening stops if it leaves more than this part of the vertices, in per
// cent.
constexpr std::uint64_t kStall = 95;

struct Shares {
  std::uint32_t parts0;
  std::uint32_t parts1;

  // Returns the maximum weight of each side. slack: for the vertices of a coarse graph.
  SideWeights max_weights(std::int64_t total, std::int64_t slack) const {
    SideWeights max_weights{};
    const std::int64_t parts = std::int64_t{parts0} + parts1;
    for (std::size_t s = 0; s < 2; ++s) {
      const std::int64_t own = s == 0 ? parts0 : parts1;
      const std::int64_t share = (total * own + parts - 1) / parts;
      max_weights[s] = std::min(share + share / kSlack + slack, total - (parts - own));
    }
    return max_weights;
  }
};

std::int64_t total_weight(const Graph& graph) {
  return std::accumulate(graph.weight.begin(), graph.weight.end(), std::int64_t{0});
}

// Returns the eigenvectors of the least eigenvalues of the Laplacian L, except the constant
// one: those of the largest of s (1 - e e^T / n) - L, which is positive semidefinite if s is at
// least the largest of L.
std::vector<std::vector<double>> fiedler_vectors(const Graph& graph) {
  const std::size_t n = graph.num_vertices();
  std::vector<double> degree(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
      degree[v] += graph.edge_weight[e];
    }
  }
  const double shift = 2.0 * *std::max_element(degree.begin(), degree.end()) + 1.0;
  std::vector<double> matrix(n * n, -shift / static_cast<double>(n));
  for (std::uint32_t v = 0; v < n; ++v) {
    matrix[v * n + v] += shift - degree[v];
    for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
      matrix[v * n + graph.neighbour[e]] += graph.edge_weight[e];
    }
  }
  return leading_eigenvectors(matrix, n, kVectors, 0.0).vectors;
}

// Divides by spectral bisection: the first vertices along an eigenvector are on side 0. Returns
// the best of several divisions, once they are refined.
Sides bisect_coarsest(const Graph& graph, const Shares& shares,
                      const SideWeights& max_weights) {
  const std::uint32_t n = graph.num_vertices();
  const std::int64_t total = total_weight(graph);
  Sides best(n, 0);
  std::int64_t min = -1;
  for (const auto& vector : fiedler_vectors(graph)) {
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return vector[a] != vector[b] ? vector[a] < vector[b] : a < b;
    });
    for (int turn = 0; turn < 2; ++turn) {
      Sides side(n, 1);
      std::int64_t weight = 0;
      for (const std::uint32_t v : order) {
        if (weight * (shares.parts0 + shares.parts1) >= total * shares.parts0) break;
        side[v] = 0;
        weight += graph.weight[v];
      }
      refine_bisection(graph, max_weights, side);
      const std::int64_t cut = cut_weight(graph, side);
      if (min < 0 || cut < min) {
        min = cut;
        best = std::move(side);
      }
      std::reverse(order.begin(), order.end());
    }
  }
  return best;
}

}  // namespace

Sides bisect(const Graph& graph, std::uint32_t parts0, std::uint32_t parts1) {
  const Shares shares{parts0, parts1};
  const std::int64_t total = total_weight(graph);
  std::vector<CoarseGraph> levels;
  const auto at = [&](std::size_t i) -> const Graph& {
    return i == 0 ? graph : levels[i - 1].graph;
  };
  // Light enough for the sides to be balanced.
  const auto max_weight = static_cast<std::uint32_t>(3 * total / (2 * kCoarsest) + 1);
  while (at(levels.size()).num_vertices() > kCoarsest) {
    const std::uint64_t before = at(levels.size()).num_vertices();
    CoarseGraph coarse = coarsen(at(levels.size()), max_weight);
    if (coarse.graph.num_vertices() * std::uint64_t{100} > before * kStall) break;
    levels.push_back(std::move(coarse));
  }
  const auto slack = [&](const Graph& of) {
    return std::int64_t{*std::max_element(of.weight.begin(), of.weight.end())} - 1;
  };
  const Graph& coarsest = at(levels.size());
  Sides side = bisect_coarsest(coarsest, shares, shares.max_weights(total, slack(coarsest)));
  for (std::size_t i = levels.size(); i-- > 0;) {
    const Graph& fine = at(i);
    Sides projected(fine.num_vertices());
    for (std::uint32_t v = 0; v < projected.size(); ++v) {
      projected[v] = side[levels[i].coarse_of[v]];
    }
    side = std::move(projected);
    refine_bisection(fine, shares.max_weights(total, slack(fine)), side);
  }
  return side;
}

}  // namespace rlpc
