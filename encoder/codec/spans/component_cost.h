// Estimates the Lagrangian cost of one principal component of a GOF without coding it.
#pragma once

#include <algorithm>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {

// tuned (off: 0): A candidate is encoded if its expected cost is at most this fraction above
// the least. Expected costs are wrong by about as much; a wider margin only takes time.
inline constexpr double kTryMargin = 0.1;

// tuned (off: 1): Fraction of the energy of a component that prediction is assumed to leave
// where it is not measured: for temporal values, and for samples whose vertices are far apart.
inline constexpr double kPredictionLeft = 0.1;

// Returns the Lagrangian cost of coding a value of which prediction leaves `left`, mean square.
// Both are relative to the error of a quantiser, step^2 / 12. The error is left / (1 + left):
// small values are rounded to zero. The rate is log2(1 + left) / 2 bits, each worth 2 ln 2
// (lagrangian.h).
inline double expected_value_cost(double left) {
  constexpr double kLn2 = 0.6931471805599453;  // fixed: ln 2
  return left / (1.0 + left) + kLn2 * det_log2(1.0 + left);
}

// Returns the expected Lagrangian cost of coding the component, or of dropping it if cheaper.
//
//   energy            energy of the component, squared grid steps
//   vertices          number of vertices in the GOF, each with one spatial factor
//   values            number of temporal values: 3 x frames
//   spatial_residual  mean square of the prediction residual of a spatial factor
//   step              quantiser step, grid steps
inline double expected_component_cost(double energy, double vertices, double values,
                                      double spatial_left, double step) {
  const double error = step * step / 12.0;  // error of a coded value
  const double cost = vertices * expected_value_cost(spatial_left / error) +
                      values * expected_value_cost(kPredictionLeft * energy / (values * error));
  return std::min(energy, error * cost);
}

// tuned (off: 1): Error of a coded value relative to that of a uniform quantiser, in forecasts
// of errors. Most small values are rounded to zero and err by less than half a step.
inline constexpr double kCodedError = 0.6;
// tuned (off: 1): Squared error of a temporal value relative to that of a spatial one, without
// bones. Each temporal value affects all vertices and has few contexts to share its cost with.
inline constexpr double kTemporalError = 0.8;

// Returns the expected squared error of a component: about its energy or its quantisation
// error, whichever is smaller.
inline double expected_component_error(double energy, double vertices, double frames,
                                       double step) {
  const double values = vertices + 3.0 * kTemporalError * frames;
  const double quantised = kCodedError * step * step / 12.0 * values;
  return energy * quantised / (energy + quantised);
}

}  // namespace rlpc
