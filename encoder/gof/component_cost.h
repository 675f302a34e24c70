// Estimates the Lagrangian cost of one principal component of a GOF without coding it.
#pragma once

#include <algorithm>

#include "encoder/gof/lagrangian.h"
#include "encoder/math/det_math.h"

namespace rlpc {

// A candidate is encoded if its estimated cost exceeds the lowest cost by less than this
// fraction.
inline constexpr double kTryMargin = 0.1;  // tuned (off: 1e9): of what is encoded

// Expected Lagrangian cost of coding the component, or of dropping it if that is cheaper.
//
//   energy            energy of the component, squared grid steps
//   vertices          number of vertices in the GOF, each with one spatial factor
//   values            number of temporal values: 3 x frames
//   spatial_residual  mean square of the prediction residual of a spatial factor
//   step              quantiser step, grid steps
inline double expected_component_cost(double energy, double vertices, double values,
                                      double spatial_residual, double step) {
  constexpr double kTemporalLeft =
      0.25;  // tuned (off: 1): energy that temporal prediction leaves
  const double error = step * step / 12.0;  // mean squared error of a coded value
  const double bits = 0.5 * vertices * det_log2(1.0 + spatial_residual / error) +
                      0.5 * values * det_log2(1.0 + kTemporalLeft * energy / (values * error));
  return std::min(energy, error * (vertices + values) + lambda(step) * bits);
}

}  // namespace rlpc
