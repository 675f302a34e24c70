// Tracks of the Main profile, 8.12 and 8.14.2 backwards: residuals in closed loop, with the
// predictor that costs the fewest bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/bone_gof.h"
#include "common/bones.h"
#include "common/residual_models.h"

namespace rlpc {

// Models and means of the tracks of one kind (9.8.1, 9.8.2), as they stand before the next one.
struct TrackState {
  explicit TrackState(std::uint32_t num_frames) : mean(num_frames, 0) {}
  ResidualModels models;
  std::vector<std::uint32_t> mean;
};

// Bits of a track in this state, which moves on past it.
double track_bits(TrackState& state, const TrackResiduals& residuals);

// A trajectory: values [num_frames] of unit `step`, 3 coordinates each.
//   refine  also tries weights fitted to the series
// Sets predictor, weights and residuals; the state moves on past it.
void code_trajectory(std::span<const std::array<double, 3>> values, double step, bool refine,
                     TrackState& state, Trajectory& trajectory);

// Where a bone is to be in a frame, in world coordinates and 1/16 grid units.
struct WantedPose {
  std::array<double, 4> rotation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z; of unit length
  std::array<double, 3> origin{};                      // where the pivot goes
};

// A bone: its flags, pivot, parent and steps are given; sets orders and residuals, and returns
// the motion that a decoder sees.
BoneMotion code_bone(std::span<const WantedPose> wanted, const BoneMotion* parent,
                     TrackState& rotations, TrackState& origins, Bone& bone);

}  // namespace rlpc
