// Eigenvectors of symmetric tridiagonal matrices, of which the eigenvalues are known.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace rlpc {

// Inverse iteration (Wilkinson 1965), each vector made orthogonal to those before it. None if
// some vector does not converge, which values that are no eigenvalues would do.
//
//   diagonal  [n], n > 0
//   beside    [n - 1], above and below the diagonal
//   values    [count], descending
//   returns   [count][n], orthonormal
std::optional<std::vector<std::vector<double>>> tridiagonal_eigenvectors(
    std::span<const double> diagonal, std::span<const double> beside,
    std::span<const double> values);

}  // namespace rlpc
