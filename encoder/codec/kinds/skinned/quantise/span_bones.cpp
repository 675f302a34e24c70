#include "encoder/codec/kinds/skinned/quantise/span_bones.h"

#include <cstddef>
#include <utility>

#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"
#include "encoder/codec/math/det_math.h"

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

namespace {

// Sets rotations and stretches relative to the parent as it was decoded. above: the parent;
// null: none.
void set_relative_poses(const Bone& bone, const BoneMotion* above,
                        std::span<const AxisImages> axes, std::span<WantedPose> wanted) {
  const Eigen::Matrix3d along = matrix_of(stretch_axes(bone));
  Eigen::Matrix3d local = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    const Eigen::Matrix3d whole = matrix_of(axes[f]);
    local = above == nullptr ? whole : quotient(matrix_of(above->poses[f].axes), whole, local);
    rotation = rotation_of(local, rotation);
    wanted[f].rotation = rotation_quaternion(rotation);
    if (f > 0) keep_sign(wanted[f - 1].rotation, wanted[f].rotation);
    wanted[f].stretch = stretch_along(along, rotation, local);
  }
}

}  // namespace

SpanBones::SpanBones(std::vector<SkinnedGof>& gofs, const TrackOptions& options)
    : gofs_(gofs), options_(options) {
  for (const SkinnedGof& gof : gofs) states_.emplace_back(gof.num_frames);
}

void SpanBones::add(const Bone& bone, std::vector<WantedPose> wanted,
                    std::span<const AxisImages> axes) {
  BoneMotion motion;
  BoneMotion parent;  // motion of the parent in the frames of a GOF
  for (std::size_t g = 0; g < gofs_.size(); ++g) {
    const std::size_t count = gofs_[g].num_frames;
    const std::size_t first = motion.poses.size();
    if (bone.parent >= 0) {
      const BoneMotion& whole = motions_[static_cast<std::size_t>(bone.parent)];
      const auto begin = whole.poses.begin() + static_cast<std::ptrdiff_t>(first);
      parent.pivot = whole.pivot;
      parent.is_stretched = whole.is_stretched;
      parent.poses.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    }
    const BoneMotion* const above = bone.parent < 0 ? nullptr : &parent;
    const auto gof_poses = std::span(wanted).subspan(first, count);
    if (!axes.empty()) set_relative_poses(bone, above, axes.subspan(first, count), gof_poses);
    Bone& coded = gofs_[g].bones.emplace_back(bone);
    const BoneMotion part = code_bone(gof_poses, above, options_, states_[g], coded);
    motion.pivot = part.pivot;
    motion.is_stretched = part.is_stretched;
    motion.poses.insert(motion.poses.end(), part.poses.begin(), part.poses.end());
  }
  motions_.push_back(std::move(motion));
}

}  // namespace rlpc
