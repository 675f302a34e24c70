// 8.12 Bones: reconstructs rigid motions from residuals, in integers.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/fixed_point.h"
#include "common/int_math.h"
#include "common/mesh/mesh.h"
#include "common/skinned_gof/skinned_gof.h"

namespace rlpc {

// Unit quaternion w, x, y, z with 30 fractional bits.
using Quaternion = std::array<std::int64_t, 4>;
inline constexpr Quaternion kNoRotation{std::int64_t{1} << kQuaternionFractionBits, 0, 0, 0};

// 8.12.1 StepOf( idx ), idx <= kMaxStepIdx; below 2^30.
std::int64_t step_of(std::uint32_t idx);

// 8.12.4 NormalizeQuaternion( q ): the unit quaternion along q; no rotation if q is zero.
// |coordinates| < 2^56.
Quaternion normalize_quaternion(Quaternion q);
// 8.12.4 RotationAfter( p, q ): q followed by p, a unit quaternion; |coordinates of q| <= 2^30.
Quaternion rotation_after(const Quaternion& p, const Quaternion& q);
// 8.12.4 AxesOf( q ): the images of the x, y and z axis.
std::array<Vec3l, 3> axes_of(const Quaternion& q);

// The pose of a bone in one frame.
struct BonePose {
  Quaternion rotation = kNoRotation;
  std::array<Vec3l, 3> axes{};
  Vec3l origin{};
};

struct BoneMotion {
  Vec3l pivot{};
  std::vector<BonePose> poses;  // [num_gof_frames]
};

// 8.12.3 Moved point; |point| < 2^31.
Vec3l moved_point(const BonePose& pose, const Vec3l& pivot, const Vec3l& point);

// 8.12.2 Motion of a bone, frame by frame: the decoder adds the residuals of the stream, the
// encoder derives them from the predictions.
class BoneTracker {
 public:
  // parent: the complete motion of the parent; null for a root.
  BoneTracker(const Bone& bone, const BoneMotion* parent);

  // Prediction for the next frame: the rotation relative to the parent, and the origin that
  // follows from the parent and the previous offset.
  Quaternion predicted_rotation() const;
  Vec3l predicted_origin() const;
  // Adds the next frame; residuals that the flags of the bone exclude are ignored.
  void add(const Vec3i& rotation_residual, const Vec3i& origin_residual);

  const BoneMotion& motion() const { return motion_; }

 private:
  Vec3l anchor() const;
  Vec3l predicted_offset() const;

  const Bone& bone_;
  const BoneMotion* parent_;
  BoneMotion motion_;
  std::vector<Quaternion> relative_;
  std::vector<Vec3l> offset_;
};

// Reconstructs all bones of a GOF.
std::vector<BoneMotion> recon_bones(std::span<const Bone> bones, std::uint32_t num_frames);

}  // namespace rlpc
