#include "encoder/codec/sequence/rival.h"

#include <algorithm>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// Returns the squared error of all frames, in the measure of the target.
double error_of(const Target& target, const Metrics& metrics) {
  if (target.kind == Target::kMaxError) return metrics.max_error * metrics.max_error;
  double sum = 0.0;
  for (const auto& frame : metrics.frames) sum += frame.squared_error;
  return sum;
}

}  // namespace

bool Rival::is_out_of_reach(const BatchTrial& trial, double far) const {
  // tuned (off: 0): The rate is a power of the squared error that differs from kRateOfError by
  // up to this much.
  constexpr double kUncertain = 0.3;
  constexpr double kMinError = 1e-30;  // fixed: above zero
  const double error = std::max(error_of(target_, trial.metrics), kMinError);
  const double other = std::max(error_of(target_, best_.metrics), kMinError);
  const double apart = std::max(error / other, other / error);
  return bits_at_equal_error(static_cast<double>(trial.gof_bytes), error / other) >
         far * det_exp2(kUncertain * det_log2(apart)) *
             bits_at_equal_error(static_cast<double>(best_.gof_bytes), 1.0);
}

}  // namespace rlpc
