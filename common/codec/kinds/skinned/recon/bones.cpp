#include "common/codec/kinds/skinned/recon/bones.h"

#include <algorithm>
#include <cassert>

#include "common/codec/kernels/component_sum.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

constexpr int kScaledBits = 28;  // FloorLog2 of the largest coordinate after scaling
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

// 8.12.4 Quaternions
Quaternion normalize_quaternion(Quaternion q) {
  std::int64_t largest = 0;
  for (const std::int64_t x : q) largest = std::max(largest, x < 0 ? -x : x);
  if (largest == 0) return kNoRotation;
  const int shift = floor_log2(static_cast<std::uint64_t>(largest)) - kScaledBits;
  std::int64_t squares = 0;
  for (std::int64_t& x : q) {
    x = shift_by(x, shift);
    squares += x * x;
  }
  const std::int64_t norm = isqrt(squares);
  for (std::int64_t& x : q) {
    x = div_round(x * (std::int64_t{1} << kQuaternionFractionBits), norm);
  }
  return q;
}

Quaternion rotation_after(const Quaternion& p, const Quaternion& q) {
  Quaternion product{p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
                     p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
                     p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
                     p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
  for (std::int64_t& x : product) x = round2(x, kQuaternionFractionBits);
  return normalize_quaternion(product);
}

std::array<Vec3l, 3> axes_of(const Quaternion& q) {
  const auto [w, x, y, z] = q;
  constexpr std::int64_t kOne = std::int64_t{1} << kQuaternionFractionBits;
  const auto twice = [](std::int64_t product) {
    return round2(product, kQuaternionFractionBits - 1);
  };
  return {{{kOne - twice(y * y + z * z), twice(x * y + w * z), twice(x * z - w * y)},
           {twice(x * y - w * z), kOne - twice(x * x + z * z), twice(y * z + w * x)},
           {twice(x * z + w * y), twice(y * z - w * x), kOne - twice(x * x + y * y)}}};
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
