// Solves small symmetric systems of linear equations, with sums in a fixed order.
#pragma once

#include <array>
#include <cstddef>

namespace rlpc {

// At most N equations: a x = b.
template <std::size_t N>
struct SmallSystem {
  std::array<std::array<double, N>, N> a{};
  std::array<double, N> b{};
};

template <std::size_t N>
struct SmallSolution {
  std::array<double, N> x{};
  bool is_unique = true;  // false: unknowns without a pivot are 0
};

// Solves for the first n unknowns; the others are 0. Only values above min_pivot are used as
// pivots.
template <std::size_t N>
SmallSolution<N> solve_small(SmallSystem<N> system, std::size_t n = N, double min_pivot = 0.0) {
  auto& [a, b] = system;
  SmallSolution<N> solution;
  for (std::size_t k = 0; k < n; ++k) {
    if (!(a[k][k] > min_pivot)) {
      solution.is_unique = false;
      continue;
    }
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  auto& x = solution.x;
  for (std::size_t k = n; k-- > 0;) {
    if (!(a[k][k] > min_pivot)) continue;
    double sum = b[k];
    for (std::size_t j = k + 1; j < n; ++j) sum -= a[k][j] * x[j];
    x[k] = sum / a[k][k];
  }
  return solution;
}

}  // namespace rlpc
