// Small systems of linear equations by elimination, their sums in a fixed order.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace rlpc {

// Up to three equations; the right sides stand in the last column.
using Equations3 = std::array<std::array<double, 4>, 3>;

// Solves the first n equations of a symmetric matrix for the first n unknowns; none where a
// pivot is not greater than least_pivot. The other unknowns are 0.
inline std::optional<std::array<double, 3>> solve3(Equations3 m, std::size_t n = 3,
                                                   double least_pivot = 0.0) {
  for (std::size_t i = 0; i < n; ++i) {
    if (!(m[i][i] > least_pivot)) return std::nullopt;
    for (std::size_t r = i + 1; r < n; ++r) {
      const double factor = m[r][i] / m[i][i];
      for (std::size_t k = i; k < 4; ++k) m[r][k] -= factor * m[i][k];
    }
  }
  std::array<double, 3> x{};
  for (std::size_t i = n; i-- > 0;) {
    double sum = m[i][3];
    for (std::size_t k = i + 1; k < n; ++k) sum -= m[i][k] * x[k];
    x[i] = sum / m[i][i];
  }
  return x;
}

}  // namespace rlpc
