#include "common/codec/kinds/skinned/recon/quaternion.h"

#include <algorithm>

namespace rlpc {
namespace {

constexpr int kScaledBits = 28;  // FloorLog2 of the largest coordinate after scaling

}  // namespace

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

BoneAxes axes_of(const Quaternion& q) {
  const auto [w, x, y, z] = q;
  constexpr std::int64_t kOne = std::int64_t{1} << kQuaternionFractionBits;
  const auto twice = [](std::int64_t product) {
    return round2(product, kQuaternionFractionBits - 1);
  };
  return {{{kOne - twice(y * y + z * z), twice(x * y + w * z), twice(x * z - w * y)},
           {twice(x * y - w * z), kOne - twice(x * x + z * z), twice(y * z + w * x)},
           {twice(x * z + w * y), twice(y * z - w * x), kOne - twice(x * x + y * y)}}};
}

BoneAxes product_of_axes(const BoneAxes& p, const BoneAxes& q, int bits) {
  BoneAxes axes{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int64_t sum = p[0][c] * q[k][0] + p[1][c] * q[k][1] + p[2][c] * q[k][2];
      axes[k][c] = round2(sum, bits);
    }
  }
  return axes;
}

// 8.12.5 Stretch
BoneAxes axes_after(const BoneAxes& p, const BoneAxes& q, int bits) {
  constexpr std::int64_t kOne = std::int64_t{1} << kQuaternionFractionBits;
  BoneAxes axes = product_of_axes(p, q, bits);
  for (Vec3l& axis : axes) {
    for (std::int64_t& x : axis) x = clip3(-kOne, kOne, x);
  }
  return axes;
}

}  // namespace rlpc
