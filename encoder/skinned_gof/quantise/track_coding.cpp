#include "encoder/skinned_gof/quantise/track_coding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/cluster_gof/cluster_gof.h"
#include "common/cluster_gof/cluster_models.h"
#include "common/skinned_gof/recon/skinned_recon.h"
#include "encoder/gof/lagrangian.h"
#include "encoder/gof/residual_choice.h"
#include "encoder/math/det_math.h"
#include "encoder/math/small_system.h"
#include "encoder/write/bit_cost.h"
#include "encoder/write/write_residual.h"

namespace rlpc {
namespace {

constexpr double kWeightScale = 64.0;  // fixed: of temporal_weight
constexpr double kMaxWeight = 255.0;   // fixed: format
constexpr int kWeightBits = 9;         // fixed: format
// Lower bound of the real part that the vector part of a residual rotation is divided by.
constexpr double kMinRealPart = 0.1;  // fixed: turns of nearly half a circle

// Least-squares weights for predicting each value from the `count` values before it.
bool fit_weights(std::span<const std::array<double, 3>> values, double step, int count,
                 std::array<std::int16_t, kMaxTemporalWeights>& weights) {
  SmallSystem<kMaxTemporalWeights> m;  // normal equations
  const auto n = static_cast<std::size_t>(count);
  for (std::size_t f = n; f < values.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
          m.a[i][k] += values[f - 1 - i][c] * values[f - 1 - k][c];
        }
        m.b[i] += values[f - 1 - i][c] * values[f][c];
      }
    }
  }
  // Prediction is from decoded values, whose quantisation errors act as regularisation.
  for (std::size_t i = 0; i < n; ++i) {
    m.a[i][i] += 3.0 * step * step / 12.0 * static_cast<double>(values.size());
  }
  const auto solution = solve_small(m, n);
  if (!solution.is_unique) return false;
  for (std::size_t i = 0; i < n; ++i) {
    weights[i] = static_cast<std::int16_t>(
        round_to_int(std::clamp(solution.x[i] * kWeightScale, -kMaxWeight, kMaxWeight)));
  }
  return true;
}

// Chooses the residuals of a track, frame by frame.
class ResidualChoice {
 public:
  ResidualChoice(const TrackState& before, bool nearest)
      : state_(before), context_(state_.mean), nearest_(nearest) {}
  ResidualChoice(const ResidualChoice&) = delete;  // the context refers to the state
  ResidualChoice& operator=(const ResidualChoice&) = delete;

  // The residuals of the next frame; wanted: in steps.
  Vec3i next(const std::array<double, 3>& wanted) {
    Vec3i residual{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t expected = context_.expected(frame_, c);
      residual[c] = nearest_ ? rounded_residual(wanted[c], 0.5)
                             : cheaper_residual(state_.models, expected, wanted[c]);
      const double error = wanted[c] - residual[c];
      error_ += error * error;
      write_residual(bits_, state_.models, expected, residual[c]);
      context_.update(frame_, c, residual[c]);
    }
    ++frame_;
    return residual;
  }
  TrackCost cost() const { return {bits_.bits(), error_}; }
  TrackState take_state() { return std::move(state_); }

 private:
  TrackState state_;
  TrackContext context_;
  bool nearest_;
  std::uint32_t frame_ = 0;
  BitCost bits_;
  double error_ = 0.0;
};

// The residuals with a given predictor; none, early, if they cost at least as much as `other`.
std::optional<TrackResiduals> residuals_of(std::span<const std::array<double, 3>> values,
                                           double step, const Trajectory& trajectory,
                                           const TrackCost& other, ResidualChoice& choice) {
  TrackResiduals residuals;
  std::vector<Vec3i> coded;
  coded.reserve(values.size());
  for (const auto& value : values) {
    if (lagrangian_cost(choice.cost()) >= lagrangian_cost(other)) return std::nullopt;
    const Vec3l prediction = predict_trajectory(trajectory, coded);
    std::array<double, 3> wanted{};
    for (std::size_t c = 0; c < 3; ++c) {
      wanted[c] = value[c] / step - static_cast<double>(prediction[c]);
    }
    const Vec3i residual = choice.next(wanted);
    Vec3i now{};
    for (std::size_t c = 0; c < 3; ++c) {
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

// The residual rotation from the predicted to the wanted rotation, in steps.
std::array<double, 3> rotation_residual(const QuaternionD& relative,
                                        const Quaternion& predicted, double step) {
  QuaternionD turn = product(inverse(predicted), relative);
  if (turn[0] < 0.0) {
    for (double& x : turn) x = -x;
  }
  const double real = std::max(turn[0], kMinRealPart);
  std::array<double, 3> residual{};
  for (std::size_t c = 0; c < 3; ++c) {
    residual[c] = turn[c + 1] / real * exact_exp2(kQuaternionFractionBits) / step;
  }
  return residual;
}

// Codes a bone with its current orders.
BoneMotion track_bone(std::span<const WantedPose> wanted, const BoneMotion* parent, Bone& bone,
                      ResidualChoice& rotations, ResidualChoice& origins) {
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
      rotation = rotations.next(
          rotation_residual(relative, tracker.predicted_rotation(), rotation_step));
      bone.rotation_residual.push_back(rotation);
    }
    Vec3i origin{};
    if (bone.origin_flag) {
      const Vec3l predicted = tracker.predicted_origin();
      std::array<double, 3> steps{};
      for (std::size_t c = 0; c < 3; ++c) {
        steps[c] = (wanted[f].origin[c] - static_cast<double>(predicted[c])) / origin_step;
      }
      origin = origins.next(steps);
      bone.origin_residual.push_back(origin);
    }
    tracker.add(rotation, origin);
  }
  return tracker.motion();
}

}  // namespace

TrackCost code_trajectory(std::span<const std::array<double, 3>> values, double step,
                          const TrackOptions& options, TrackState& state,
                          Trajectory& trajectory) {
  TrackState best_state = state;
  TrackCost best{0.0, std::numeric_limits<double>::infinity()};
  Trajectory tried = trajectory;
  const int last = options.refine ? kMaxTemporalPredictor : kMaxPredictorOrder;
  for (tried.temporal_predictor = 1; tried.temporal_predictor <= last;
       ++tried.temporal_predictor) {
    const int count = tried.temporal_predictor - kMaxPredictorOrder;
    if (count > 0 && !fit_weights(values, step, count, tried.temporal_weight)) continue;
    ResidualChoice choice(state, options.nearest);
    auto residuals = residuals_of(values, step, tried, best, choice);
    if (!residuals) continue;
    tried.residual = std::move(*residuals);
    TrackCost cost = choice.cost();
    if (count > 0) cost.bits += kWeightBits * count;
    if (lagrangian_cost(cost) >= lagrangian_cost(best)) continue;
    best = cost;
    trajectory = tried;
    best_state = choice.take_state();
  }
  state = std::move(best_state);
  return best;
}

BoneMotion code_bone(std::span<const WantedPose> wanted, const BoneMotion* parent, bool nearest,
                     TrackState& rotations, TrackState& origins, Bone& bone) {
  // The two orders are independent up to rounding: choose that of rotations, then that of
  // origins.
  const auto choose = [&](int& order, int first, bool of_rotations) {
    double best = std::numeric_limits<double>::infinity();
    int best_order = first;
    for (order = first; order <= kMaxPredictorOrder; ++order) {
      ResidualChoice rotation(rotations, nearest);
      ResidualChoice origin(origins, nearest);
      track_bone(wanted, parent, bone, rotation, origin);
      const double now = lagrangian_cost((of_rotations ? rotation : origin).cost());
      if (now >= best) continue;
      best = now;
      best_order = order;
    }
    order = best_order;
  };
  if (bone.rotation_flag) choose(bone.rotation_order, 1, true);
  if (bone.origin_flag) choose(bone.origin_order, 0, false);
  ResidualChoice rotation(rotations, nearest);
  ResidualChoice origin(origins, nearest);
  BoneMotion motion = track_bone(wanted, parent, bone, rotation, origin);
  rotations = rotation.take_state();
  origins = origin.take_state();
  return motion;
}

}  // namespace rlpc
