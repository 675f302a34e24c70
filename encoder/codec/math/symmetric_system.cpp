#include "encoder/codec/math/symmetric_system.h"

#include <utility>

#include "encoder/codec/math/matrix_products.h"

namespace rlpc {
namespace {

// Subtracts factor * row `from` of b from row `to`.
void subtract_row(std::span<double> b, std::size_t width, double factor, std::size_t from,
                  std::size_t to) {
  if (width == 1) {
    b[to] -= factor * b[from];
  } else {
    subtract_multiple(factor, b.subspan(from * width, width), b.subspan(to * width, width));
  }
}

}  // namespace

SymmetricSystem::SymmetricSystem(std::vector<double> a, std::size_t n, double min_pivot)
    : n_(n), factors_(std::move(a)) {
  std::vector<double> diagonal(n);
  for (std::size_t k = 0; k < n; ++k) diagonal[k] = factors_[k * n + k];
  for (std::size_t k = 0; k < n; ++k) {  // right-looking: updates are independent
    double* top = &factors_[k * n];
    if (!(top[k] > min_pivot * diagonal[k] && top[k] > 0.0)) {
      top[k] = 0.0;
      is_unique_ = false;
      continue;
    }
    for (std::size_t i = k + 1; i < n; ++i) {
      if (top[i] == 0.0) continue;
      const double factor = top[i] / top[k];
      subtract_multiple(factor, {top + i, n - i}, {&factors_[i * n + i], n - i});
    }
  }
}

void SymmetricSystem::solve(std::span<double> b, std::size_t width) const {
  for (std::size_t k = 0; k < n_; ++k) {
    const double* top = &factors_[k * n_];
    if (top[k] == 0.0) continue;
    for (std::size_t i = k + 1; i < n_; ++i) {
      if (top[i] != 0.0) subtract_row(b, width, top[i] / top[k], k, i);
    }
  }
  for (std::size_t k = n_; k-- > 0;) {
    const double* top = &factors_[k * n_];
    for (std::size_t j = k + 1; j < n_ && top[k] != 0.0; ++j) {
      if (top[j] != 0.0) subtract_row(b, width, top[j], j, k);
    }
    for (double& x : b.subspan(k * width, width)) x = top[k] == 0.0 ? 0.0 : x / top[k];
  }
}

}  // namespace rlpc
