// 8.12.4 Quaternions of rotations, in integers.
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/bits/fixed_point.h"
#include "common/codec/bits/int_math.h"

namespace rlpc {

// Unit quaternion (w, x, y, z) with 30 fractional bits.
using Quaternion = std::array<std::int64_t, 4>;
inline constexpr Quaternion kNoRotation{std::int64_t{1} << kQuaternionFractionBits, 0, 0, 0};

// 8.12.4 NormalizeQuaternion( q ): the unit quaternion along q; no rotation if q is zero.
// |coordinates| < 2^56.
Quaternion normalize_quaternion(Quaternion q);
// 8.12.4 RotationAfter( p, q ): q followed by p, a unit quaternion; |coordinates of q| <= 2^30.
Quaternion rotation_after(const Quaternion& p, const Quaternion& q);
// 8.12.4 TurnedTowards( p, q ): returns whether it is -q rather than q.
constexpr bool is_opposite(const Quaternion& p, const Quaternion& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] < 0;
}
// Images of the x, y and z axes under a rotation, 30 fractional bits, or under a stretch.
using BoneAxes = std::array<Vec3l, 3>;
// 8.12.4 AxesOf( q )
BoneAxes axes_of(const Quaternion& q);
// The images under q followed by p; bits: fractional bits that a product of coordinates has
// more than the result.
BoneAxes product_of_axes(const BoneAxes& p, const BoneAxes& q, int bits);
// 8.12.5 AxesAfter( p, q, bits ): the images under q followed by p; |coordinates| <= 2^30 + 32.
BoneAxes axes_after(const BoneAxes& p, const BoneAxes& q, int bits);

inline constexpr int kStretchFractionBits = 28;

}  // namespace rlpc
