// Scalar product of vectors of any length, for tests.
#pragma once

#include <cstddef>
#include <vector>

namespace rlpc {

inline double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace rlpc
