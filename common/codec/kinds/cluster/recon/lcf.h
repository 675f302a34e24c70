// Local coordinate frames (clause 8.4), computed from the integer positions of three seed
// vertices.
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/bits/fixed_point.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/mesh/mesh.h"

namespace rlpc {

struct Lcf {
  Vec3l doubled_origin;       // p1 + p2: the midpoint, doubled to be an integer
  std::array<Vec3l, 3> axis;  // x, y, z; unit vectors with 30 fractional bits
};

// 8.4.1 Frame of a seed triangle. |p| <= 2^23. Degenerate triangles yield the result of 8.4.2.
Lcf make_lcf(const Vec3i& p1, const Vec3i& p2, const Vec3i& p3);

// 8.4.3 World position of local coordinates; |local| <= 2^30.
// Width: 2^24 * 2^33 + 3 * (2^30 + 32) * 2^30 < 2^62.
inline Vec3l lcf_to_world(const Lcf& lcf, std::int64_t x, std::int64_t y, std::int64_t z) {
  Vec3l p{};
  for (std::size_t c = 0; c < 3; ++c) {
    constexpr int kOriginShift = kAxisFractionBits + kLocalFractionBits - 1;
    const std::int64_t sum = lcf.doubled_origin[c] * (std::int64_t{1} << kOriginShift) +
                             lcf.axis[0][c] * x + lcf.axis[1][c] * y + lcf.axis[2][c] * z;
    p[c] = round2(sum, kAxisFractionBits + kLocalFractionBits);
  }
  return p;
}

}  // namespace rlpc
