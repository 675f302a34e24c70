// 8.15 Adaptive weights: the filter that adapts the weights of one vertex, also to the frames
// of an inter GOF (8.19).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace rlpc {

inline constexpr std::size_t kMaxFilterSize = 32;  // neighbours, and padding to whole vectors
inline constexpr std::size_t kFilterVector = 8;    // neighbours in a vector
inline constexpr int kAdaptiveFractionBits = 16;   // fractional bits of weights
inline constexpr std::int32_t kMaxAdaptiveWeight = (1 << 19) - 1;
inline constexpr int kSpreadFractionBits = 28;
inline constexpr int kOffsetLog2 = 9;  // largest offset after the shift
inline constexpr int kGainBits = 14;
// Minimum part of the variance along the offsets that remains after a sample. Gains of 14 bits
// need it: with 1/2^14, filters diverge in inter GOFs, with 1/2^12, few do; 1/2^8 takes up to
// 1 % more bytes.
inline constexpr int kVarianceKeptLog2 = 10;
inline constexpr int kSpreadShift = 12;      // from a step of the walk to the first spread
inline constexpr int kLaterSpreadShift = 9;  // same, in later component groups

// 8.15.3: ranges of a filter. The scale has spread_fraction - gain_shift fractional bits.
struct FilterForm {
  std::int32_t max_spread;
  int gain_shift;
  std::int32_t max_error;

  constexpr int scale_bits() const { return kSpreadFractionBits - gain_shift; }
};
// 8.15: filter of spatial factors. The variance of a residual, after the shifts, is 1.
inline constexpr FilterForm kFactorFilter{(1 << 22) - 1, 7, 1 << 10};
inline constexpr std::int64_t kFactorNoise = std::int64_t{1} << kFactorFilter.scale_bits();
// 8.19: filter of positions. The variance of a residual has 16 fractional bits.
inline constexpr FilterForm kFrameFilter{1 << 26, 11, 1 << 14};
inline constexpr int kVarianceFractionBits = 16;
inline constexpr std::int64_t kMinFrameNoise = std::int64_t{1} << 14;
inline constexpr std::int64_t kMaxFrameNoise = std::int64_t{1} << 41;

// Filter of one vertex: lists of `size` neighbours, padded with zeros to `stride`, a multiple
// of kFilterVector.
struct FilterState {
  std::size_t size = 0;
  std::size_t stride = 0;
  std::int32_t* weight = nullptr;      // AdaptiveWeights[ v ]
  const std::int32_t* walk = nullptr;  // RandomWalk( v, i )
  std::int32_t* spread = nullptr;      // rows, [size][stride]
};

// Filter with room for the largest size.
struct WeightFilter {
  std::size_t size = 0;  // neighbours, ring first
  std::size_t stride = 0;
  alignas(32) std::array<std::int32_t, kMaxFilterSize> weight{};
  alignas(32) std::array<std::int32_t, kMaxFilterSize> walk{};
  alignas(32) std::array<std::int32_t, kMaxFilterSize * kMaxFilterSize> spread{};

  FilterState state() { return {size, stride, weight.data(), walk.data(), spread.data()}; }
  // 8.15.1 StartSpread( ). weights: [size], of which the first ring_size are in the ring;
  // shift: kSpreadShift or kLaterSpreadShift.
  void start(std::span<const std::int32_t> weights, std::size_t ring_size, int shift);
};

// Shifts that scale the step of a filter, from its gains and their scale.
struct FilterShifts {
  int narrow;
  int weighting;
  int spreading;
  std::int32_t inverse;

  // noise, variance: the two parts of the scale of 8.15.3, of the residual and along the
  // offsets; largest: magnitude of the gains, at least 1.
  FilterShifts(const FilterForm& form, std::int64_t noise, std::int64_t variance,
               std::uint32_t largest);
};

// 8.19.4: returns the variance of a residual after a shift of offsets, in the unit of the
// scale.
std::int64_t frame_noise(std::int64_t variance, int shift);

// 8.15.2 PredictOffset( ); offsets [stride], |offset| < 2^31.
std::int64_t predict_offset(const FilterState& filter, const std::int32_t* offsets);
// 8.15.3 Adapt( ), for spatial factors; |offset| <= 2^29, |error| < 2^34.
void adapt(const FilterState& filter, const std::int32_t* offsets, std::int64_t error);
// 8.15.3 Adapt( ), for positions; |offset| < 2^31 - 2^20, |error| < 2^40; variance: of the
// residual.
void adapt_to_frame(const FilterState& filter, const std::int32_t* offsets, std::int64_t error,
                    std::int64_t variance);

}  // namespace rlpc
