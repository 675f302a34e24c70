// 8.2.2 Physical predictors of a series (Vasa and Skala 2009, 4). Order 0 predicts zero, order
// 1 the previous value; orders 2, 3 and 4 assume constant speed, acceleration and change of
// acceleration.
#pragma once

#include <algorithm>
#include <cstdint>

namespace rlpc {

// Predicts the value at f. The order is limited to the number of predecessors. series(i)
// returns the value at i < f; |values| < 2^32, so the prediction is below 2^36.
template <class Series>
std::int64_t predict_series(const Series& series, std::uint32_t f, int order) {
  switch (std::min<std::uint32_t>(f, static_cast<std::uint32_t>(order))) {
    case 0:
      return 0;
    case 1:
      return series(f - 1);
    case 2:
      return 2 * series(f - 1) - series(f - 2);
    case 3:
      return 3 * series(f - 1) - 3 * series(f - 2) + series(f - 3);
    default:
      return 4 * series(f - 1) - 6 * series(f - 2) + 4 * series(f - 3) - series(f - 4);
  }
}

}  // namespace rlpc
