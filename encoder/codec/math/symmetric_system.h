// Solves symmetric systems of any number of linear equations, with sums in a fixed order.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rlpc {

// Solves a x = b by the factorisation a = L D L^T.
class SymmetricSystem {
 public:
  // Default of min_pivot. A pivot that is at most min_pivot times the diagonal element
  // before elimination is not used; the unknown is then 0.
  static constexpr double kRounding = 1e-14;

  //   a  [n][n], row-major, positive semidefinite; only the upper triangle is read
  explicit SymmetricSystem(std::vector<double> a, std::size_t n, double min_pivot = kRounding);

  bool is_unique() const { return is_unique_; }  // whether all unknowns have a pivot
  // Replaces b by x; [n][width], row-major.
  void solve(std::span<double> b, std::size_t width = 1) const;

 private:
  std::size_t n_;
  std::vector<double> factors_;  // [n][n], rows of D L^T; a pivot of 0 is not used
  bool is_unique_ = true;
};

}  // namespace rlpc
