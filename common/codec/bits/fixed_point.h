// Fractional bits and widths of the fixed-point numbers of reconstruction.
#pragma once

#include <cstdint>

#include "common/codec/bits/int_math.h"

namespace rlpc {

// 8.4 Local coordinate frames
inline constexpr int kLocalFractionBits = 4;  // local coordinates: 1/16 grid step
inline constexpr int kLocalBits = 31;         // local coordinates are clipped to this width
inline constexpr int kAxisFractionBits = 30;  // unit vectors of the axes

// 8.12 Bones
inline constexpr int kQuaternionFractionBits = 30;
inline constexpr int kPointFractionBits = 4;  // positions of the rest shape and of moved points

// Rounds a point to the grid.
constexpr std::int64_t to_grid(std::int64_t point) {
  return round2(point, kPointFractionBits) * (1 << kPointFractionBits);
}

}  // namespace rlpc
