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
// 8.12.4 AxesOf( q ): the images of the x, y and z axis.
std::array<Vec3l, 3> axes_of(const Quaternion& q);

}  // namespace rlpc
