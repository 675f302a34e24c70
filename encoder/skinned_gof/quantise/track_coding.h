// Codes the tracks of bones and trajectories in closed loop, with residuals and predictors
// chosen by rate and distortion (inverse of 8.12 and 8.14.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/bitstream/residual_models.h"
#include "common/skinned_gof/recon/bones.h"
#include "common/skinned_gof/skinned_gof.h"
#include "encoder/gof/lagrangian.h"

namespace rlpc {

// Models and means shared by the tracks of one type (9.8.1, 9.8.2): the state before the next
// track.
struct TrackState {
  explicit TrackState(std::uint32_t num_frames) : mean(num_frames, 0) {}
  ResidualModels models;
  std::vector<std::uint32_t> mean;
};

struct TrackCost {
  double bits = 0.0;
  double error = 0.0;  // sum of squared errors of all values, in squared steps
};

// D + lambda R, in squared steps.
inline double lagrangian_cost(const TrackCost& cost) {
  return cost.error + kLambda * cost.bits;
}

struct TrackOptions {
  bool refine = true;    // also try transmitted weights, fitted to the series
  bool nearest = false;  // round residuals to nearest; else errors are below one step
};

// Codes a trajectory: sets predictor, weights and residuals, advances the state, and returns
// the cost.
//
//   values  [num_frames], 3 coordinates each
//   step    quantiser step, in the unit of the values
TrackCost code_trajectory(std::span<const std::array<double, 3>> values, double step,
                          const TrackOptions& options, TrackState& state,
                          Trajectory& trajectory);

// The pose of a bone in a frame before quantisation, in world coordinates and 1/16 grid units.
struct WantedPose {
  std::array<double, 4> rotation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z; of unit length
  std::array<double, 3> origin{};                      // position of the pivot
};

// Codes a bone whose flags, pivot, parent and steps are given: sets orders and residuals,
// advances the states, and returns the motion that a decoder recovers. nearest: as in
// TrackOptions.
BoneMotion code_bone(std::span<const WantedPose> wanted, const BoneMotion* parent, bool nearest,
                     TrackState& rotations, TrackState& origins, Bone& bone);

}  // namespace rlpc
