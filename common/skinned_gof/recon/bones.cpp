#include "common/skinned_gof/recon/bones.h"

#include <algorithm>
#include <cassert>

#include "common/components/series_predictor.h"
#include "common/kernels/component_sum.h"

namespace rlpc {
namespace {

constexpr int kScaledBits = 28;  // FloorLog2 of the largest coordinate after scaling
constexpr int kResidualBits = 31;
constexpr int kOriginBits = 31;

// Coordinate c of a series whose values before frame f are known.
template <class Series>
std::int64_t predict_coordinate(const Series& series, std::size_t c, int order) {
  return predict_series([&](std::uint32_t f) { return series[f][c]; },
                        static_cast<std::uint32_t>(series.size()), order);
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

BoneTracker::BoneTracker(const Bone& bone, const BoneMotion* parent)
    : bone_(bone), parent_(parent) {
  for (std::size_t c = 0; c < 3; ++c) motion_.pivot[c] = bone.pivot[c];
}

Quaternion BoneTracker::predicted_rotation() const {
  if (!bone_.rotation_flag || relative_.empty()) return kNoRotation;
  Quaternion sums{};
  for (std::size_t c = 0; c < 4; ++c) {
    sums[c] = predict_coordinate(relative_, c, bone_.rotation_order);
  }
  return normalize_quaternion(sums);
}

// The position of the pivot if it moves with the parent in the next frame.
Vec3l BoneTracker::anchor() const {
  if (parent_ == nullptr) return motion_.pivot;
  return moved_point(parent_->poses[motion_.poses.size()], parent_->pivot, motion_.pivot);
}

Vec3l BoneTracker::predicted_offset() const {
  Vec3l offset{};
  if (!bone_.origin_flag) return offset;
  for (std::size_t c = 0; c < 3; ++c) {
    offset[c] = predict_coordinate(offset_, c, bone_.origin_order);
  }
  return offset;
}

Vec3l BoneTracker::predicted_origin() const {
  Vec3l origin = anchor();
  const Vec3l offset = predicted_offset();
  for (std::size_t c = 0; c < 3; ++c) origin[c] += offset[c];
  return origin;
}

// 8.12.2 Motion of a bone
void BoneTracker::add(const Vec3i& rotation_residual, const Vec3i& origin_residual) {
  BonePose pose;
  Quaternion relative = predicted_rotation();
  if (bone_.rotation_flag) {
    Quaternion turn = kNoRotation;
    for (std::size_t c = 0; c < 3; ++c) {
      turn[c + 1] =
          clip_signed(kResidualBits, rotation_residual[c] * step_of(bone_.rotation_step_idx));
    }
    relative = rotation_after(relative, turn);
  }
  pose.rotation = relative;
  if (parent_ != nullptr) {
    pose.rotation = rotation_after(parent_->poses[motion_.poses.size()].rotation, relative);
  }
  pose.axes = axes_of(pose.rotation);
  Vec3l offset = predicted_offset();
  const Vec3l point = anchor();
  for (std::size_t c = 0; c < 3; ++c) {
    if (bone_.origin_flag) {
      offset[c] = clip_signed(kOriginBits,
                              offset[c] + origin_residual[c] * step_of(bone_.origin_step_idx));
    }
    pose.origin[c] = clip_signed(kOriginBits, point[c] + offset[c]);
  }
  relative_.push_back(relative);
  offset_.push_back(offset);
  motion_.poses.push_back(pose);
}

std::vector<BoneMotion> recon_bones(std::span<const Bone> bones, std::uint32_t num_frames) {
  std::vector<BoneMotion> motions;
  motions.reserve(bones.size());  // trackers point to those of parents
  for (const Bone& bone : bones) {
    BoneTracker tracker(
        bone, bone.parent < 0 ? nullptr : &motions[static_cast<std::size_t>(bone.parent)]);
    for (std::uint32_t f = 0; f < num_frames; ++f) {
      tracker.add(bone.rotation_flag ? bone.rotation_residual[f] : Vec3i{},
                  bone.origin_flag ? bone.origin_residual[f] : Vec3i{});
    }
    motions.push_back(tracker.motion());
  }
  return motions;
}

}  // namespace rlpc
