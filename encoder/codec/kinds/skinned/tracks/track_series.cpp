#include "encoder/codec/kinds/skinned/tracks/track_series.h"

#include <algorithm>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/residual_choice.h"

namespace rlpc {
namespace {

// Lower bound of the real part that the vector part of a residual rotation is divided by.
constexpr double kMinRealPart = 0.1;  // fixed: turns of nearly half a circle

}  // namespace

QuaternionD product(const QuaternionD& p, const QuaternionD& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
          p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
          p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

QuaternionD inverse(const Quaternion& q) {
  const double one = exact_exp2(-kQuaternionFractionBits);
  return {static_cast<double>(q[0]) * one, -static_cast<double>(q[1]) * one,
          -static_cast<double>(q[2]) * one, -static_cast<double>(q[3]) * one};
}

// Returns the rotation from the predicted to the wanted rotation, in steps.
std::array<double, 3> RotationSeries::wanted_residual(const Quaternion& prediction,
                                                      std::uint32_t f) const {
  QuaternionD turn = product(inverse(prediction), wanted_[f]);
  if (turn[0] < 0.0) {
    for (double& x : turn) x = -x;
  }
  const double scale = exact_exp2(kQuaternionFractionBits) /
                       (std::max(turn[0], kMinRealPart) * static_cast<double>(step_));
  return {turn[1] * scale, turn[2] * scale, turn[3] * scale};
}

double RotationSeries::follow(const Predicted& predicted, Vec3i& residual,
                              std::size_t c) const {
  double error = 0.0;
  for (std::size_t other = 0; other < 3; ++other) {
    if (other == c) continue;
    const double wanted = predicted.wanted[other];
    if (std::abs(wanted - residual[other]) >= 1.0) {
      residual[other] = rounded_residual(wanted, 0.5);
    }
    const double difference = wanted - residual[other];
    error += difference * difference;
  }
  return error;
}

Quaternion RotationSeries::ideal(std::uint32_t f, std::size_t /*c*/) const {
  Quaternion q{};
  for (std::size_t k = 0; k < 4; ++k) {
    q[k] = round_to_int(wanted_[f][k] * exact_exp2(kQuaternionFractionBits));
  }
  return q;
}

// Whether they differ by less than what half a step changes.
bool RotationSeries::are_alike(const Value& a, const Value& b) const {
  std::int64_t sum = 0;
  for (std::size_t c = 0; c < 4; ++c) sum += std::abs(a[c] - b[c]);
  return 2 * sum < step_;
}

}  // namespace rlpc
