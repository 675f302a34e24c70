// Fits the bones of a shared rig, as it was coded, to further frames.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/kinds/skinned/fit/bone_poses.h"
#include "encoder/codec/kinds/skinned/tracks/track_coding.h"
#include "encoder/codec/math/symmetric_system.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// The poses of a bone in some frames.
struct FittedPoses {
  std::vector<WantedPose> poses;  // rotations in world coordinates
  std::vector<AxisImages> axes;   // of a stretched bone, as in RigBone; otherwise empty
};

class PoseFit {
 public:
  // rest: rest positions, 1/16 grid units. Keeps a reference to the rig.
  PoseFit(const SharedRig& rig, const std::array<std::vector<std::int32_t>, 3>& rest);

  // Fits the poses of all bones in some frames, [bone], as far as joints and bones that do not
  // rotate allow. Quaternions keep their sign from frame to frame.
  std::vector<FittedPoses> fit(const SpanFrames& frames,
                               std::span<const std::uint32_t> chosen) const;

 private:
  using Motions = std::vector<Motion>;  // [bone]

  Motions rigid_motions(const SpanFrames& frames, std::uint32_t frame,
                        const Vec3d& centre) const;
  void fit_some(const SpanFrames& frames, std::span<const std::uint32_t> chosen,
                std::span<Motions> motions) const;
  void keep_joints(std::span<const Motion> targets, const Vec3d& centre,
                   Motions& motions) const;
  void make_linear_system();
  void fit_linear_maps(std::span<const Motion> targets, Motions& motions) const;

  const SharedRig& rig_;
  Vec3d rest_centre_ = Vec3d::Zero();            // the positions below are relative to it
  std::vector<Vec3d> rest_;                      // [vertex]
  std::vector<std::vector<RigWeight>> weights_;  // [vertex]
  std::vector<std::uint32_t> nearest_;           // [vertex]: bone of the largest weight
  SkinMoments moments_;
  bool is_free_ = true;             // all bones rotate and shift
  std::vector<bool> is_stretched_;  // [bone]: by itself or with one above it
  // Equations for all maps of a frame together, without regard to rotations; none without
  // stretched bones, or with very many bones.
  std::optional<SymmetricSystem> linear_;
  std::vector<double> damping_;  // [unknown]
};

}  // namespace rlpc
