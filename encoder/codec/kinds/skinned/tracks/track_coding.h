// Codes the tracks of bones and trajectories in closed loop, with residuals and predictors
// chosen by rate and distortion (inverse of 8.12 and 8.14.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/recon/bones.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/kinds/skinned/tracks/track_state.h"

namespace rlpc {

struct TrackOptions {
  bool refine = true;        // also try transmitted weights, fitted to the series
  bool nearest = false;      // round residuals to nearest; else errors are below one step
  int track_levels = 0;      // above 0: hierarchical orders are tried too
  bool only_levels = false;  // only these are tried, as cutting needs levels
  bool fast = false;   // fewer predictors, and fewer survivors in the search for residuals
  bool draft = false;  // only the likeliest predictor and no search, to compare candidates
};

// Codes a trajectory: sets predictor, weights and residuals, advances the state, and returns
// the cost.
//
//   values  [num_frames], 3 coordinates each
//   step    quantiser step, in the unit of the values
TrackCost code_trajectory(std::span<const std::array<double, 3>> values, double step,
                          const TrackOptions& options, TrackState& state,
                          Trajectory& trajectory);

// The pose of a bone in a frame before quantisation.
struct WantedPose {
  // w, x, y, z; of unit length. In world coordinates or, of a stretched bone, relative to its
  // parent.
  std::array<double, 4> rotation{1.0, 0.0, 0.0, 0.0};
  std::array<double, 3> origin{};  // position of the pivot in the world, 1/16 grid units
  std::array<double, 3> stretch{1.0, 1.0, 1.0};  // its own, along its axes
};

// States of the tracks of bones.
struct BoneTrackStates {
  explicit BoneTrackStates(std::uint32_t num_frames)
      : rotations(num_frames), origins(num_frames), stretches(num_frames) {}
  TrackState rotations;
  TrackState origins;
  TrackState stretches;
};

// Codes a bone whose flags, pivot, parent and steps are given: sets orders and residuals,
// advances the states, and returns the motion that a decoder recovers.
BoneMotion code_bone(std::span<const WantedPose> wanted, const BoneMotion* parent,
                     const TrackOptions& options, BoneTrackStates& states, Bone& bone);

}  // namespace rlpc
