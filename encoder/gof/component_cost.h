// What a principal component of a GOF is expected to cost, before anything is coded.
#pragma once

#include <algorithm>

#include "encoder/gof/lagrangian.h"
#include "encoder/math/det_math.h"

namespace rlpc {

// What is expected to cost up to so much more than the least may be the best.
inline constexpr double kTryMargin = 0.1;  // tuned (off: 1e9): of what is encoded

// Lagrangian cost of coding the component, or of leaving it out where that is cheaper.
//
//   energy         of the component, in squared grid steps
//   vertices       of the GOF, each with one spatial factor
//   values         temporal ones: 3 x frames
//   spatial_left   mean square of what prediction leaves of a spatial factor
//   step           of the quantisers, in grid steps
inline double expected_component_cost(double energy, double vertices, double values,
                                      double spatial_left, double step) {
  constexpr double kTemporalLeft =
      0.25;  // tuned (off: 1): energy that temporal prediction leaves
  const double error = step * step / 12.0;  // of a coded value
  const double bits = 0.5 * vertices * det_log2(1.0 + spatial_left / error) +
                      0.5 * values * det_log2(1.0 + kTemporalLeft * energy / (values * error));
  return std::min(energy, error * (vertices + values) + lambda(step) * bits);
}

}  // namespace rlpc
