// Symmetric systems of any number of linear equations, solved with sums in a fixed order.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rlpc {

// a x = b, by the factors L D L^T of a.
class SymmetricSystem {
 public:
  // Unknowns without a pivot, of which elimination leaves no more than this part of the
  // diagonal, are 0.
  static constexpr double kRounding = 1e-14;

  //   a  [n][n], row-major, positive semidefinite; only the upper triangle is read
  explicit SymmetricSystem(std::vector<double> a, std::size_t n,
                           double least_pivot = kRounding);

  bool is_unique() const { return is_unique_; }  // all unknowns have a pivot
  // Replaces b by x; [n][width], row-major.
  void solve(std::span<double> b, std::size_t width = 1) const;

 private:
  std::size_t n_;
  std::vector<double> factors_;  // [n][n], rows of D L^T; a pivot of 0: none
  bool is_unique_ = true;
};

}  // namespace rlpc
