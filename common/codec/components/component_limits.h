// Limits of components of all kinds of GOF (7.5.7, 7.12.1).
#pragma once

#include <cstddef>

namespace rlpc {

inline constexpr int kMaxFractionBits = 24;
inline constexpr int kMaxPredictorOrder = 4;
inline constexpr int kMaxSpatialBits = 24;
inline constexpr int kMaxTemporalBits = 26;
inline constexpr int kTemporalIndexBits = 24;  // width of temporal values before scaling
inline constexpr int kMaxScaleIdx = 127;

// Spatial values are summed in tiles of this size (common/codec/kernels): small enough for the
// first-level cache; a multiple of 16. Memory estimates count whole tiles.
inline constexpr std::size_t kTileValues = 64;

}  // namespace rlpc
