// 8.12 Bones: reconstructs rigid motions, and their stretch, from residuals, in integers.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/codec/bits/fixed_point.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/components/series_predictor.h"
#include "common/codec/components/track_order.h"
#include "common/codec/kinds/skinned/recon/quaternion.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr int kOriginBits = 31;  // offsets and origins are clipped to this width

// 8.12.1 StepOf( idx ), idx <= kMaxStepIdx; below 2^30.
std::int64_t step_of(std::uint32_t idx);

// Pose of a bone in one frame.
struct BonePose {
  Quaternion rotation = kNoRotation;  // not used of a stretched bone
  BoneAxes axes{};
  Vec3l origin{};
};

struct BoneMotion {
  std::int32_t parent = -1;  // index; -1: root
  Vec3l pivot{};
  bool is_stretched = false;  // the bone or one that it descends from stretches
  BoneAxes along{};           // stretch_axes()
  Vector<BonePose> poses;     // [num_gof_frames]
};

// 8.12.3 Moved point; |point| < 2^31.
Vec3l moved_point(const BonePose& pose, const Vec3l& pivot, const Vec3l& point);

// 8.12.2 Motion of a bone: predicts the rotation relative to the parent, and the offset of the
// origin, at a place of a track from the values at earlier places. relative(f) returns a
// rotation, offset(f) a coordinate.
template <class Relative>
Quaternion predict_rotation(const Relative& relative, const TrackPlace& at, int order) {
  if (at.frame == 0) return kNoRotation;
  Quaternion sums{};
  if (at.neighbours > 0) {
    const Quaternion& before = relative(at.frame - at.stride);
    for (std::size_t c = 0; c < 4; ++c) {
      sums[c] = sum_of_neighbours(
          [&](std::uint32_t f) {
            const Quaternion& q = relative(f);
            return is_opposite(before, q) ? -q[c] : q[c];
          },
          at);
    }
  } else {
    for (std::size_t c = 0; c < 4; ++c) {
      sums[c] = predict_series([&](std::uint32_t i) { return relative(i * at.stride)[c]; },
                               at.frame / at.stride, order);
    }
  }
  return normalize_quaternion(sums);
}
template <class Offset>
std::int64_t predict_offset(const Offset& offset, const TrackPlace& at, int order) {
  if (at.neighbours > 0) {
    return round2(sum_of_neighbours(offset, at), at.neighbours == 2 ? 1 : 4);
  }
  return predict_series([&](std::uint32_t i) { return offset(i * at.stride); },
                        at.frame / at.stride, order);
}

// Return the rotation, and the coordinate of an offset, for a residual.
Quaternion rotation_from(const Quaternion& predicted, const Vec3i& residual, std::int64_t step);
constexpr std::int64_t offset_from(std::int64_t predicted, std::int32_t residual,
                                   std::int64_t step) {
  return clip_signed(kOriginBits, predicted + residual * step);
}

// The axes along which a bone stretches; those of the rest shape if it does not.
BoneAxes stretch_axes(const Bone& bone);
// 8.12.5 StretchMap( b, differences ): the images of the axes of the rest shape. along:
// stretch_axes().
BoneAxes stretch_map(const BoneAxes& along, const Vec3l& differences);

// Values of a bone relative to its parent, [num_gof_frames] each.
struct RelativeMotion {
  Vector<Quaternion> rotations;
  Vector<Vec3l> offsets;    // of the origin
  Vector<Vec3l> stretches;  // 8.12.5: differences of the factors
};
// Returns the motion of a bone. parent: null for a root.
BoneMotion move_bone(const Bone& bone, const BoneMotion* parent,
                     const RelativeMotion& relative);

// Returns the place in frame f to which the parent moves the pivot of a bone: its origin
// without an offset.
Vec3l carried_pivot(const Bone& bone, const BoneMotion* parent, std::uint32_t f);

// Reconstructs all bones of a GOF.
Vector<BoneMotion> recon_bones(std::span<const Bone> bones, std::uint32_t num_frames,
                               int track_levels);

}  // namespace rlpc
