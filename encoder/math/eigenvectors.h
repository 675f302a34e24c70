// Eigenvectors of symmetric matrices without negative eigenvalues.
#pragma once

#include <cstddef>
#include <vector>

namespace rlpc {

struct EigenPairs {
  std::vector<double> values;                // descending
  std::vector<std::vector<double>> vectors;  // [count][width], orthonormal, of the first values
};

// Vectors of the values above `least`, at most max_count. Values of all vectors, or of a wide
// matrix with few vectors of these alone and some that follow: then time is quadratic in the
// width, not cubic.
//
//   matrix  [width][width], the lower triangle is read
//   least   not negative
EigenPairs leading_eigenvectors(const std::vector<double>& matrix, std::size_t width,
                                std::size_t max_count, double least);

}  // namespace rlpc
