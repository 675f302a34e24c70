// 8.15 Adaptive weights: the filter that adapts the weights of one vertex.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace rlpc {

inline constexpr std::size_t kMaxFilterSize = 32;  // neighbours, and padding to whole vectors
inline constexpr std::size_t kFilterVector = 8;    // neighbours of a vector
inline constexpr int kAdaptiveFractionBits = 16;   // of weights
inline constexpr std::int32_t kMaxAdaptiveWeight = (1 << 19) - 1;
inline constexpr std::int32_t kMaxSpread = (1 << 22) - 1;
inline constexpr int kSpreadShift = 12;      // of the first spread, from a step of the walk
inline constexpr int kLaterSpreadShift = 9;  // likewise, at later component groups
inline constexpr int kOffsetLog2 = 9;        // of the largest offset, shifted
inline constexpr std::int32_t kMaxFilterError = 1024;
inline constexpr int kGainShift = 7;
inline constexpr std::int64_t kMinScale = 1 << 21;
inline constexpr int kGainBits = 14;

// Lists are padded with zeros to `stride`, a multiple of kFilterVector.
struct WeightFilter {
  std::size_t size = 0;  // neighbours, ring first
  std::size_t stride = 0;
  alignas(32) std::array<std::int32_t, kMaxFilterSize> weight{};  // AdaptiveWeights[ v ]
  alignas(32) std::array<std::int32_t, kMaxFilterSize> walk{};    // RandomWalk( v, i )
  alignas(32) std::array<std::int32_t, kMaxFilterSize * kMaxFilterSize> spread{};  // rows

  // 8.15.1 StartSpread( ): weights are those of `size` neighbours, the first ring_size of them
  // in the ring; shift: kSpreadShift or kLaterSpreadShift.
  void start(std::span<const std::int32_t> weights, std::size_t ring_size, int shift);
};

// How the step of a filter is scaled, by its gains and their scale.
struct FilterShifts {
  int narrow;
  int weighting;
  int spreading;
  std::int32_t inverse;

  // scale: of 8.15.3, before it is raised; largest: magnitude of the gains, at least 1.
  FilterShifts(std::int64_t scale, std::uint32_t largest);
};

// 8.15.2 PredictOffset( ); offsets [stride], |offset| <= 2^24.
std::int64_t predict_offset(const WeightFilter& filter, const std::int32_t* offsets);
// 8.15.3 Adapt( ); |offset| <= 2^29, |error| < 2^34.
void adapt(WeightFilter& filter, const std::int32_t* offsets, std::int64_t error);

}  // namespace rlpc
