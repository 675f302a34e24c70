#include "common/codec/kinds/skinned/recon/bones.h"

#include <algorithm>
#include <cassert>

#include "common/codec/kernels/component_sum.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

constexpr int kResidualBits = 31;

// Returns the rotations relative to the parent, [num_frames].
Vector<Quaternion> recon_rotations(const Bone& bone, std::uint32_t num_frames,
                                   int track_levels) {
  Vector<Quaternion> relative(num_frames, kNoRotation);
  if (!bone.rotation_flag) return relative;
  const auto known = [&](std::uint32_t f) -> const Quaternion& { return relative[f]; };
  const std::int64_t step = step_of(bone.rotation_step_idx);
  for (const TrackPlace& at : track_order(num_frames, track_levels, bone.rotation_between)) {
    const Quaternion predicted = predict_rotation(known, at, bone.rotation_order);
    relative[at.frame] = rotation_from(predicted, bone.rotation_residual[at.frame], step);
  }
  return relative;
}

// Returns the offsets of the origin, [num_frames].
Vector<Vec3l> recon_offsets(const Bone& bone, std::uint32_t num_frames, int track_levels) {
  Vector<Vec3l> offset(num_frames);
  if (!bone.origin_flag) return offset;
  const std::int64_t step = step_of(bone.origin_step_idx);
  for (const TrackPlace& at : track_order(num_frames, track_levels, bone.origin_between)) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto known = [&](std::uint32_t f) { return offset[f][c]; };
      offset[at.frame][c] = offset_from(predict_offset(known, at, bone.origin_order),
                                        bone.origin_residual[at.frame][c], step);
    }
  }
  return offset;
}

}  // namespace

// 8.12.1 Steps
std::int64_t step_of(std::uint32_t idx) {
  assert(idx <= kMaxStepIdx);
  return round2(std::int64_t{kScaleMantissa[idx % 8]} << (idx / 8), 15);
}

// 8.12.3 Moved point
Vec3l moved_point(const BonePose& pose, const Vec3l& pivot, const Vec3l& point) {
  const Vec3l arm{point[0] - pivot[0], point[1] - pivot[1], point[2] - pivot[2]};
  Vec3l moved{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t sum =
        pose.axes[0][c] * arm[0] + pose.axes[1][c] * arm[1] + pose.axes[2][c] * arm[2];
    moved[c] = round2(sum, kQuaternionFractionBits) + pose.origin[c];
  }
  return moved;
}

// 8.12.2 Motion of a bone
Quaternion rotation_from(const Quaternion& predicted, const Vec3i& residual,
                         std::int64_t step) {
  Quaternion turn = kNoRotation;
  for (std::size_t c = 0; c < 3; ++c) {
    turn[c + 1] = clip_signed(kResidualBits, residual[c] * step);
  }
  return rotation_after(predicted, turn);
}

Vec3l carried_pivot(const Bone& bone, const BoneMotion* parent, std::uint32_t f) {
  const Vec3l pivot{bone.pivot[0], bone.pivot[1], bone.pivot[2]};
  return parent == nullptr ? pivot : moved_point(parent->poses[f], parent->pivot, pivot);
}

BoneMotion move_bone(const Bone& bone, const BoneMotion* parent,
                     std::span<const Quaternion> relative, std::span<const Vec3l> offset) {
  BoneMotion motion;
  motion.parent = bone.parent;
  motion.pivot = {bone.pivot[0], bone.pivot[1], bone.pivot[2]};
  motion.poses.resize(relative.size());
  for (std::uint32_t f = 0; f < relative.size(); ++f) {
    BonePose& pose = motion.poses[f];
    pose.rotation = relative[f];
    if (parent != nullptr) {
      pose.rotation = rotation_after(parent->poses[f].rotation, relative[f]);
    }
    pose.axes = axes_of(pose.rotation);
    const Vec3l place = carried_pivot(bone, parent, f);
    for (std::size_t c = 0; c < 3; ++c) {
      pose.origin[c] = clip_signed(kOriginBits, place[c] + offset[f][c]);
    }
  }
  return motion;
}

Vector<BoneMotion> recon_bones(std::span<const Bone> bones, std::uint32_t num_frames,
                               int track_levels) {
  Vector<BoneMotion> motions;
  motions.reserve(bones.size());  // children refer to their parents
  for (const Bone& bone : bones) {
    const auto parent = static_cast<std::size_t>(bone.parent);
    motions.push_back(move_bone(bone, bone.parent < 0 ? nullptr : &motions[parent],
                                recon_rotations(bone, num_frames, track_levels),
                                recon_offsets(bone, num_frames, track_levels)));
  }
  return motions;
}

}  // namespace rlpc
