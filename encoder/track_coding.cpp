#include "encoder/track_coding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/bone_recon.h"
#include "common/gof.h"
#include "encoder/bit_cost.h"
#include "encoder/det_math.h"
#include "encoder/elimination.h"
#include "encoder/write_track.h"

namespace rlpc {
namespace {

constexpr double kWeightScale = 64.0;  // of temporal_weight
constexpr double kMaxWeight = 255.0;
constexpr int kWeightBits = 9;
// The smallest real part of a residual rotation that its vector part is divided by.
constexpr double kMinRealPart = 0.1;

std::int32_t to_residual(double x) {
  constexpr auto kMost = static_cast<double>(kMaxResidual);
  return static_cast<std::int32_t>(round_to_int(std::clamp(x, -kMost, kMost)));
}

// Weights of the `count` values before that predict the series best, in least squares.
bool fit_weights(std::span<const std::array<double, 3>> values, double step, int count,
                 std::array<std::int16_t, kMaxTemporalWeights>& weights) {
  Equations3 m{};  // normal equations
  const auto n = static_cast<std::size_t>(count);
  for (std::size_t f = n; f < values.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
          m[i][k] += values[f - 1 - i][c] * values[f - 1 - k][c];
        }
        m[i][3] += values[f - 1 - i][c] * values[f][c];
      }
    }
  }
  // What is predicted from has quantisation errors.
  for (std::size_t i = 0; i < n; ++i) {
    m[i][i] += 0.25 * step * step * static_cast<double>(values.size());
  }
  const auto solution = solve3(m, n);
  if (!solution) return false;
  for (std::size_t i = 0; i < n; ++i) {
    weights[i] = static_cast<std::int16_t>(
        round_to_int(std::clamp((*solution)[i] * kWeightScale, -kMaxWeight, kMaxWeight)));
  }
  return true;
}

TrackResiduals residuals_of(std::span<const std::array<double, 3>> values, double step,
                            const Trajectory& trajectory) {
  TrackResiduals residuals;
  std::vector<Vec3i> coded;
  coded.reserve(values.size());
  for (const auto& value : values) {
    const Vec3l prediction = predict_trajectory(trajectory, coded);
    Vec3i residual{};
    Vec3i now{};
    for (std::size_t c = 0; c < 3; ++c) {
      residual[c] = to_residual(value[c] / step - static_cast<double>(prediction[c]));
      now[c] = clip_signed(kTemporalIndexBits, prediction[c] + residual[c]);
    }
    residuals.push_back(residual);
    coded.push_back(now);
  }
  return residuals;
}

using QuaternionD = std::array<double, 4>;

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

// The residual that turns what is predicted into what is wanted.
Vec3i rotation_residual(const QuaternionD& relative, const Quaternion& predicted, double step) {
  QuaternionD turn = product(inverse(predicted), relative);
  if (turn[0] < 0.0) {
    for (double& x : turn) x = -x;
  }
  const double real = std::max(turn[0], kMinRealPart);
  Vec3i residual{};
  for (std::size_t c = 0; c < 3; ++c) {
    residual[c] = to_residual(turn[c + 1] / real * exact_exp2(kQuaternionFractionBits) / step);
  }
  return residual;
}

// One coding of a bone with the orders that it has.
BoneMotion track_bone(std::span<const WantedPose> wanted, const BoneMotion* parent,
                      Bone& bone) {
  BoneTracker tracker(bone, parent);
  bone.rotation_residual.clear();
  bone.origin_residual.clear();
  const auto rotation_step = static_cast<double>(step_of(bone.rotation_step_idx));
  const auto origin_step = static_cast<double>(step_of(bone.origin_step_idx));
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    Vec3i rotation{};
    if (bone.rotation_flag) {
      QuaternionD relative = wanted[f].rotation;
      if (parent != nullptr) relative = product(inverse(parent->poses[f].rotation), relative);
      rotation = rotation_residual(relative, tracker.predicted_rotation(), rotation_step);
      bone.rotation_residual.push_back(rotation);
    }
    Vec3i origin{};
    if (bone.origin_flag) {
      const Vec3l predicted = tracker.predicted_origin();
      for (std::size_t c = 0; c < 3; ++c) {
        origin[c] = to_residual((wanted[f].origin[c] - static_cast<double>(predicted[c])) /
                                origin_step);
      }
      bone.origin_residual.push_back(origin);
    }
    tracker.add(rotation, origin);
  }
  return tracker.motion();
}

}  // namespace

double track_bits(TrackState& state, const TrackResiduals& residuals) {
  BitCost cost;
  write_track(cost, state.models, state.mean, residuals);
  return cost.bits();
}

void code_trajectory(std::span<const std::array<double, 3>> values, double step, bool refine,
                     TrackState& state, Trajectory& trajectory) {
  TrackState best_state = state;
  double best = std::numeric_limits<double>::infinity();
  Trajectory tried = trajectory;
  const int last = refine ? kMaxTemporalPredictor : kMaxPredictorOrder;
  for (tried.temporal_predictor = 1; tried.temporal_predictor <= last;
       ++tried.temporal_predictor) {
    const int count = tried.temporal_predictor - kMaxPredictorOrder;
    if (count > 0 && !fit_weights(values, step, count, tried.temporal_weight)) continue;
    tried.residual = residuals_of(values, step, tried);
    TrackState after = state;
    const double bits =
        track_bits(after, tried.residual) + (count > 0 ? kWeightBits * count : 0);
    if (bits >= best) continue;
    best = bits;
    trajectory = tried;
    best_state = std::move(after);
  }
  state = std::move(best_state);
}

BoneMotion code_bone(std::span<const WantedPose> wanted, const BoneMotion* parent,
                     TrackState& rotations, TrackState& origins, Bone& bone) {
  // The orders do not depend on each other but for rounding: first rotations, then origins.
  const auto choose = [&](TrackState& state, int& order, int first,
                          const TrackResiduals& residuals) {
    TrackState best_state = state;
    double best = std::numeric_limits<double>::infinity();
    int best_order = first;
    for (order = first; order <= kMaxPredictorOrder; ++order) {
      track_bone(wanted, parent, bone);
      TrackState after = state;
      const double bits = track_bits(after, residuals);
      if (bits >= best) continue;
      best = bits;
      best_order = order;
      best_state = std::move(after);
    }
    order = best_order;
    state = std::move(best_state);
  };
  if (bone.rotation_flag) choose(rotations, bone.rotation_order, 1, bone.rotation_residual);
  if (bone.origin_flag) choose(origins, bone.origin_order, 0, bone.origin_residual);
  return track_bone(wanted, parent, bone);
}

}  // namespace rlpc
