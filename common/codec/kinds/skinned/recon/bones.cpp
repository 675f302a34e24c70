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

// A track of offsets: those of the origin, or differences of stretches.
struct OffsetTrack {
  const TrackResiduals& residual;
  std::uint32_t step_idx;
  int order;
  int between;
};

// Sets the values of the track, [num_frames].
void recon_offsets(const OffsetTrack& track, int track_levels, Vector<Vec3l>& offset) {
  const std::int64_t step = step_of(track.step_idx);
  const auto num_frames = static_cast<std::uint32_t>(offset.size());
  for (const TrackPlace& at : track_order(num_frames, track_levels, track.between)) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto known = [&](std::uint32_t f) { return offset[f][c]; };
      offset[at.frame][c] = offset_from(predict_offset(known, at, track.order),
                                        track.residual[at.frame][c], step);
    }
  }
}

RelativeMotion recon_relative(const Bone& bone, std::uint32_t num_frames, int track_levels) {
  RelativeMotion relative{recon_rotations(bone, num_frames, track_levels),
                          Vector<Vec3l>(num_frames), Vector<Vec3l>(num_frames)};
  if (bone.origin_flag) {
    recon_offsets(
        {bone.origin_residual, bone.origin_step_idx, bone.origin_order, bone.origin_between},
        track_levels, relative.offsets);
  }
  if (bone.stretch != Stretch::kNone) {
    recon_offsets({bone.stretch_residual, bone.stretch_step_idx, bone.stretch_order,
                   bone.stretch_between},
                  track_levels, relative.stretches);
  }
  return relative;
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

// 8.12.5 Stretch
BoneAxes stretch_axes(const Bone& bone) {
  constexpr int kShift = kQuaternionFractionBits - (kStretchAxisBits - 1);
  Quaternion turn = kNoRotation;
  for (std::size_t c = 0; c < 3; ++c) {
    turn[c + 1] = std::int64_t{bone.stretch_axes[c]} * (std::int64_t{1} << kShift);
  }
  return axes_of(normalize_quaternion(turn));
}

BoneAxes stretch_map(const BoneAxes& along, const Vec3l& differences) {
  constexpr std::int64_t kMax = std::int64_t{1} << kQuaternionFractionBits;
  const std::int64_t first = (std::int64_t{1} << kStretchFractionBits) + differences[0];
  const Vec3l factors{first, first + differences[1], first + differences[2]};
  BoneAxes scaled{};
  BoneAxes back{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t factor = clip3(std::int64_t{0}, kMax, factors[k]);
    for (std::size_t c = 0; c < 3; ++c) {
      scaled[k][c] = round2(along[k][c] * factor, kQuaternionFractionBits);
      back[c][k] = along[k][c];
    }
  }
  return axes_after(scaled, back, kQuaternionFractionBits);
}

BoneMotion move_bone(const Bone& bone, const BoneMotion* parent,
                     const RelativeMotion& relative) {
  BoneMotion motion;
  motion.parent = bone.parent;
  motion.pivot = {bone.pivot[0], bone.pivot[1], bone.pivot[2]};
  motion.is_stretched =
      bone.stretch != Stretch::kNone || (parent != nullptr && parent->is_stretched);
  motion.poses.resize(relative.rotations.size());
  motion.along = stretch_axes(bone);
  for (std::uint32_t f = 0; f < motion.poses.size(); ++f) {
    BonePose& pose = motion.poses[f];
    pose.rotation = relative.rotations[f];
    if (parent != nullptr) {
      pose.rotation = rotation_after(parent->poses[f].rotation, relative.rotations[f]);
    }
    pose.axes = axes_of(pose.rotation);
    if (motion.is_stretched) {
      const BoneAxes local =
          axes_after(axes_of(relative.rotations[f]),
                     stretch_map(motion.along, relative.stretches[f]), kQuaternionFractionBits);
      pose.axes = axes_after(parent != nullptr ? parent->poses[f].axes : axes_of(kNoRotation),
                             local, kStretchFractionBits);
    }
    const Vec3l place = carried_pivot(bone, parent, f);
    for (std::size_t c = 0; c < 3; ++c) {
      pose.origin[c] = clip_signed(kOriginBits, place[c] + relative.offsets[f][c]);
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
                                recon_relative(bone, num_frames, track_levels)));
  }
  return motions;
}

}  // namespace rlpc
