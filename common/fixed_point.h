// Fractional bits and widths of the fixed-point numbers of reconstruction.
#pragma once

namespace rlpc {

// 8.4 Local coordinate frames
inline constexpr int kLocalFractionBits = 4;  // of local coordinates
inline constexpr int kLocalBits = 31;         // local coordinates are clipped to this width
inline constexpr int kAxisFractionBits = 30;  // of the unit vectors

// 8.12 Bones
inline constexpr int kQuaternionFractionBits = 30;
inline constexpr int kPointFractionBits = 4;  // of the rest shape, and where bones take it

}  // namespace rlpc
