#include "encoder/codec/kinds/skinned/quantise/span_bones.h"

#include <cstddef>
#include <utility>

namespace rlpc {

std::vector<SkinnedGof> gofs_of_span(const SpanFrames& frames, int track_levels) {
  std::vector<SkinnedGof> gofs;
  for (const FrameRange& span : frames.gofs()) {
    SkinnedGof& gof = gofs.emplace_back();
    gof.first_frame = frames.first_frame + span.first;
    gof.num_frames = span.count;
    gof.track_levels = track_levels;
  }
  return gofs;
}

SpanBones::SpanBones(std::vector<SkinnedGof>& gofs, const TrackOptions& options)
    : gofs_(gofs), options_(options) {
  for (const SkinnedGof& gof : gofs) {
    rotations_.emplace_back(gof.num_frames);
    origins_.emplace_back(gof.num_frames);
  }
}

void SpanBones::add(const Bone& bone, std::span<const WantedPose> wanted) {
  BoneMotion motion;
  BoneMotion parent;  // motion of the parent in the frames of a GOF
  for (std::size_t g = 0; g < gofs_.size(); ++g) {
    const std::size_t count = gofs_[g].num_frames;
    const std::size_t first = motion.poses.size();
    if (bone.parent >= 0) {
      const BoneMotion& whole = motions_[static_cast<std::size_t>(bone.parent)];
      const auto begin = whole.poses.begin() + static_cast<std::ptrdiff_t>(first);
      parent.pivot = whole.pivot;
      parent.poses.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    }
    Bone& coded = gofs_[g].bones.emplace_back(bone);
    const BoneMotion part =
        code_bone(wanted.subspan(first, count), bone.parent < 0 ? nullptr : &parent, options_,
                  rotations_[g], origins_[g], coded);
    motion.pivot = part.pivot;
    motion.poses.insert(motion.poses.end(), part.poses.begin(), part.poses.end());
  }
  motions_.push_back(std::move(motion));
}

}  // namespace rlpc
