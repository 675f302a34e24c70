// Codes the motion of the bones of a span, GOF by GOF (inverse of 8.12).
#pragma once

#include <span>
#include <vector>

#include "common/codec/kinds/skinned/recon/bones.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/kinds/skinned/tracks/track_coding.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Returns the GOFs of a span, without bones and trajectories.
std::vector<SkinnedGof> gofs_of_span(const SpanFrames& frames, int track_levels);

class SpanBones {
 public:
  // Keeps a reference to the GOFs, to which it adds bones.
  SpanBones(std::vector<SkinnedGof>& gofs, const TrackOptions& options);

  // Codes the next bone, whose flags, pivot, parent and steps are given.
  //
  //   wanted  [num_frames]
  //   axes    [num_frames]: what a stretched bone makes of the axes of the rest shape, from
  //           which rotation and stretch follow; otherwise empty
  void add(const Bone& bone, std::vector<WantedPose> wanted,
           std::span<const AxisImages> axes = {});
  // Returns the motion of the bones so far, as decoded, in all frames of the span.
  std::vector<BoneMotion>& motions() { return motions_; }

 private:
  std::vector<SkinnedGof>& gofs_;
  TrackOptions options_;
  std::vector<BoneTrackStates> states_;  // [GOF]
  std::vector<BoneMotion> motions_;
};

}  // namespace rlpc
