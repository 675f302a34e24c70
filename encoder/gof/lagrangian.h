// What a bit is worth: the Lagrange multiplier of every choice between rate and distortion.
#pragma once

#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_frames.h"

namespace rlpc {

// In squared steps per bit. At high rate a uniform quantiser of a step s adds the squared error
// D = s^2 / 12 to a value, whose rate then falls by 1 / (2 ln 2 D) bits per unit of D. Error
// and rate are in balance where a bit costs as much error as it saves: 2 ln 2 D = 0.1155 s^2.
inline constexpr double kLambda = 0.1155;  // fixed: ln 2 / 6

// Squared error that is worth a bit.
inline double lambda(double step) { return kLambda * step * step; }

inline double lagrangian_cost(const EncodedGof& encoded, const GofFrames& frames, double step) {
  double bits = 0.0;
  for (const auto& unit : encoded.units) bits += 8.0 * static_cast<double>(unit.payload.size());
  return squared_error(frames, encoded.frame) + lambda(step) * bits;
}

}  // namespace rlpc
