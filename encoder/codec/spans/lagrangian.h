// The Lagrange multiplier for all choices between rate and distortion in the encoder.
#pragma once

#include <algorithm>
#include <span>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// The multiplier in squared steps per bit. At high rate a uniform quantiser of step s adds the
// squared error D = s^2 / 12 to a value, and the rate falls by 1 / (2 ln 2 D) bits per unit of
// D. So the multiplier, -dD/dR, is 2 ln 2 D = 0.1155 s^2.
inline constexpr double kLambda = 0.1155;  // fixed: ln 2 / 6

// Returns the squared error, in squared grid steps, that one bit is worth at a quantiser step.
inline double lambda(double step) { return kLambda * step * step; }

inline double bits_of(std::span<const EncodedSpan::Unit> units) {
  double bits = 0.0;
  for (const auto& unit : units) bits += 8.0 * static_cast<double>(unit.payload.size());
  return bits;
}
inline double bits_of(const EncodedSpan& encoded) { return bits_of(encoded.units); }

// tuned: Frames from which the error of a candidate is taken. It differs little from frame to
// frame, unless each is predicted from others, and decoding takes time.
inline constexpr std::uint32_t kErrorFrames = 24;

// Returns the bits of the units of an encoded GOF, and the squared error of its decoded frames,
// from a sample unless it is known.
inline SpanCost cost_of(const EncodedSpan& encoded, const SpanFrames& frames) {
  return {bits_of(encoded), encoded.squared_error
                                ? *encoded.squared_error
                                : squared_error(frames, encoded.frame, kErrorFrames)};
}

// Returns D + lambda R.
inline double lagrangian_cost(const SpanCost& cost, double step) {
  return cost.squared_error + lambda(step) * cost.bits;
}
inline double lagrangian_cost(const EncodedSpan& encoded, const SpanFrames& frames,
                              double step) {
  return lagrangian_cost(cost_of(encoded, frames), step);
}

// Estimates bits at equal error, to compare encodings at one step whose errors differ much.
// Lagrangian costs assume a linear rate, which then favours small errors.
inline double bits_at_equal_error(double bits, double squared_error) {
  // tuned (off: 0): The rate is about this power of the squared error.
  constexpr double kRateOfError = -0.25;
  constexpr double kMinError = 1e-6;  // fixed: above zero
  return bits * det_exp2(-kRateOfError * det_log2(std::max(squared_error, kMinError)));
}

// Returns how many times as many bits an encoding takes as another at equal error.
inline double ratio_at_equal_error(const SpanCost& cost, const SpanCost& other) {
  return bits_at_equal_error(cost.bits, cost.squared_error) /
         bits_at_equal_error(other.bits, other.squared_error);
}

}  // namespace rlpc
