// Eigenvectors of symmetric tridiagonal matrices with known eigenvalues.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace rlpc {

// Returns the eigenvectors by inverse iteration (Wilkinson 1965), orthonormalised together;
// none if a vector does not converge, for example because a value is not an eigenvalue.
//
//   diagonal     [n], n > 0
//   subdiagonal  [n - 1], also above the diagonal
//   values       [count], descending
//   returns      [count][n], orthonormal
std::optional<std::vector<std::vector<double>>> tridiagonal_eigenvectors(
    std::span<const double> diagonal, std::span<const double> subdiagonal,
    std::span<const double> values);

}  // namespace rlpc
