// Eigenvectors of positive semidefinite symmetric matrices.
#pragma once

#include <cstddef>
#include <vector>

namespace rlpc {

struct EigenPairs {
  std::vector<double> values;  // descending
  std::vector<std::vector<double>>
      vectors;  // [count][width], orthonormal, for the first values
};

// Returns the eigenvectors with eigenvalues above `min`, at most max_count. `values` has all
// eigenvalues or, for a wide matrix of which few vectors are wanted, at least theirs; the time
// is then quadratic in the width instead of cubic.
//
//   matrix  [width][width], the lower triangle is read
//   least   not negative
EigenPairs leading_eigenvectors(const std::vector<double>& matrix, std::size_t width,
                                std::size_t max_count, double min);

}  // namespace rlpc
