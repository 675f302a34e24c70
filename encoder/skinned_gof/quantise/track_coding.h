// Tracks of the Main profile, 8.12 and 8.14.2 backwards: residuals in closed loop, chosen by
// rate and distortion, with the predictor that does best.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/bitstream/residual_models.h"
#include "common/skinned_gof/recon/bones.h"
#include "common/skinned_gof/skinned_gof.h"

namespace rlpc {

// Models and means of the tracks of one kind (9.8.1, 9.8.2), as they stand before the next one.
struct TrackState {
  explicit TrackState(std::uint32_t num_frames) : mean(num_frames, 0) {}
  ResidualModels models;
  std::vector<std::uint32_t> mean;
};

struct TrackCost {
  double bits = 0.0;
  double error = 0.0;  // squared, of all values, in squared steps
};

struct TrackOptions {
  bool refine = true;    // also try weights fitted to the series
  bool nearest = false;  // residuals are not more than half a step off; else less than one
};

// A trajectory: values [num_frames] of unit `step`, 3 coordinates each. Sets predictor, weights
// and residuals, and returns what they cost; the state moves on past it.
TrackCost code_trajectory(std::span<const std::array<double, 3>> values, double step,
                          const TrackOptions& options, TrackState& state,
                          Trajectory& trajectory);

// Where a bone is to be in a frame, in world coordinates and 1/16 grid units.
struct WantedPose {
  std::array<double, 4> rotation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z; of unit length
  std::array<double, 3> origin{};                      // where the pivot goes
};

// A bone: its flags, pivot, parent and steps are given; sets orders and residuals, and returns
// the motion that a decoder sees. The states move on past it. nearest: see above.
BoneMotion code_bone(std::span<const WantedPose> wanted, const BoneMotion* parent, bool nearest,
                     TrackState& rotations, TrackState& origins, Bone& bone);

}  // namespace rlpc
