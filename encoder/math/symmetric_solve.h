// Solves small dense symmetric systems with sums in a fixed order.
#pragma once

#include <cstddef>
#include <vector>

namespace rlpc {

// Replaces b by the solution x of a x = b; destroys a. Unknowns without a pivot become 0.
//
//   a  [n][n], row-major, positive semidefinite; only the upper triangle is read
//   b  [n]
inline void solve_symmetric(std::vector<double>& a, std::vector<double>& b) {
  const std::size_t n = b.size();
  std::vector<double> pivot(n);
  for (std::size_t k = 0; k < n; ++k) pivot[k] = a[k * n + k];
  constexpr double kRankTolerance = 1e-14;
  const auto usable = [&](std::size_t k) {
    return a[k * n + k] > kRankTolerance * pivot[k] && a[k * n + k] > 0.0;
  };
  for (std::size_t k = 0; k < n; ++k) {  // right-looking: updates are independent of each other
    if (!usable(k)) continue;
    const double* top = &a[k * n];
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = top[i] / top[k];
      if (factor == 0.0) continue;
      double* row = &a[i * n];
      for (std::size_t j = i; j < n; ++j) row[j] -= factor * top[j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    if (!usable(k)) {
      b[k] = 0.0;
      continue;
    }
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k * n + j] * b[j];
    b[k] /= a[k * n + k];
  }
}

}  // namespace rlpc
