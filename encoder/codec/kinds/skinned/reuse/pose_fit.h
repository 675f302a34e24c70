// Fits the bones of a shared rig, as it was coded, to further frames.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/kinds/skinned/fit/bone_poses.h"
#include "encoder/codec/kinds/skinned/tracks/track_coding.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

class PoseFit {
 public:
  // rest: rest positions, 1/16 grid units. Keeps a reference to the rig.
  PoseFit(const SharedRig& rig, const std::array<std::vector<std::int32_t>, 3>& rest);

  // Fits the poses of all bones in some frames, [bone][frame], as far as joints and bones that
  // do not rotate allow. Quaternions keep their sign from frame to frame.
  std::vector<std::vector<WantedPose>> fit(const SpanFrames& frames,
                                           std::span<const std::uint32_t> chosen) const;

 private:
  using Motions = std::vector<Motion>;  // [bone]

  Motions rigid_motions(const SpanFrames& frames, std::uint32_t frame,
                        const Vec3d& centre) const;
  void fit_some(const SpanFrames& frames, std::span<const std::uint32_t> chosen,
                std::span<Motions> motions) const;
  void keep_joints(std::span<const Motion> targets, const Vec3d& centre,
                   Motions& motions) const;

  const SharedRig& rig_;
  Vec3d rest_centre_ = Vec3d::Zero();            // the positions below are relative to it
  std::vector<Vec3d> rest_;                      // [vertex]
  std::vector<std::vector<RigWeight>> weights_;  // [vertex]
  std::vector<std::uint32_t> nearest_;           // [vertex]: bone of the largest weight
  SkinMoments moments_;
  bool is_free_ = true;  // all bones rotate and shift
};

}  // namespace rlpc
