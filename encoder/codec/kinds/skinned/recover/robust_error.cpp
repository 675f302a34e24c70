#include "encoder/codec/kinds/skinned/recover/robust_error.h"

#include <algorithm>
#include <cstddef>

#include "encoder/codec/math/det_math.h"

namespace rlpc {

double robust_scale(std::vector<double> errors) {
  constexpr double kFinest = 5e-5;  // fixed: extents; smaller errors do not matter
  const auto at = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 3 / 5);
  std::nth_element(errors.begin(), at, errors.end());
  return std::max(2.0 * *at, kFinest);
}

double robust_cost(std::span<const double> errors, double scale) {
  double sum = 0.0;
  for (const double error : errors) {
    const double relative = error / scale;
    sum += det_log2(1.0 + relative * relative);
  }
  return sum;
}

double robust_weight(double error, double scale) {
  const double relative = error / scale;
  return 1.0 / (1.0 + relative * relative);
}

}  // namespace rlpc
