#include "common/codec/kernels/weight_filter.h"

#include <algorithm>

#include "common/codec/bits/int_math.h"

namespace rlpc {
namespace {

constexpr std::int32_t kRingWalk = 256;
constexpr std::int32_t kOuterWalk = 64;

std::uint32_t magnitude(std::int32_t x) {
  return x < 0 ? 0U - static_cast<std::uint32_t>(x) : static_cast<std::uint32_t>(x);
}

}  // namespace

void WeightFilter::start(std::span<const std::int32_t> weights, std::size_t ring_size,
                         int shift) {
  size = weights.size();
  stride = (size + kFilterVector - 1) / kFilterVector * kFilterVector;
  std::fill_n(weight.begin(), stride, 0);
  std::fill_n(walk.begin(), stride, 0);
  std::fill_n(spread.begin(), stride * stride, 0);
  for (std::size_t i = 0; i < size; ++i) {
    weight[i] = weights[i];
    walk[i] = i < ring_size ? kRingWalk : kOuterWalk;
    spread[i * stride + i] = walk[i] << shift;
  }
}

FilterShifts::FilterShifts(const FilterForm& form, std::int64_t noise, std::int64_t variance,
                           std::uint32_t largest) {
  variance = std::max<std::int64_t>(variance, 0);
  const std::int64_t scale = noise + variance + (variance >> kVarianceKeptLog2);
  narrow = std::max(floor_log2(largest) - (kGainBits - 1), 0);
  const int exponent = floor_log2(static_cast<std::uint64_t>(scale)) - kGainBits;
  inverse =
      static_cast<std::int32_t>((std::int64_t{1} << (2 * kGainBits + 1)) / (scale >> exponent));
  weighting = std::clamp(exponent - narrow - 2, 0, 31);
  spreading = std::clamp(15 - form.gain_shift + exponent - 2 * narrow, 1, 31);
}

std::int64_t frame_noise(std::int64_t variance, int shift) {
  constexpr int kFiner = kFrameFilter.scale_bits() - kVarianceFractionBits;
  return std::clamp(shift_by(variance, 2 * shift - kFiner), kMinFrameNoise, kMaxFrameNoise);
}

std::int64_t predict_offset(const FilterState& filter, const std::int32_t* offsets) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < filter.size; ++i) {
    sum += std::int64_t{filter.weight[i]} * offsets[i];
  }
  return round2(sum, kAdaptiveFractionBits);
}

namespace {

// noise( shift ): variance of a residual in the unit of the scale.
template <class Noise>
void adapt_filter(const FilterForm& form, const FilterState& filter,
                  const std::int32_t* offsets, std::int64_t error, Noise noise) {
  const std::size_t n = filter.size;
  const std::size_t stride = filter.stride;
  std::uint32_t largest = 1;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, magnitude(offsets[i]));
  const int shift = std::max(floor_log2(largest) - kOffsetLog2, 0);
  const std::int64_t e =
      std::clamp<std::int64_t>(round2(error, shift), -form.max_error, form.max_error);
  std::array<std::int64_t, kMaxFilterSize> offset{};
  for (std::size_t i = 0; i < n; ++i) offset[i] = round2(offsets[i], shift);

  std::array<std::int32_t, kMaxFilterSize> gain{};
  const std::int64_t min_scale = noise(shift);
  std::int64_t scale = min_scale;
  largest = 1;
  for (std::size_t i = 0; i < n; ++i) {
    std::int64_t sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += filter.spread[i * stride + j] * offset[j];
    gain[i] = static_cast<std::int32_t>(round2(sum, form.gain_shift));
    scale += gain[i] * offset[i];
    largest = std::max(largest, magnitude(gain[i]));
  }
  const FilterShifts shifts(form, min_scale, scale - min_scale, largest);
  std::array<std::int32_t, kMaxFilterSize> change{};
  for (std::size_t i = 0; i < n; ++i) {
    gain[i] = static_cast<std::int32_t>(round2(gain[i], shifts.narrow));
    change[i] = static_cast<std::int32_t>(
        round2(std::int64_t{gain[i]} * shifts.inverse, kGainBits + 1));
  }
  for (std::size_t i = 0; i < n; ++i) {
    filter.weight[i] = static_cast<std::int32_t>(
        clip3(-kMaxAdaptiveWeight, kMaxAdaptiveWeight,
              filter.weight[i] + round2(change[i] * e, shifts.weighting)));
    for (std::size_t j = 0; j <= i; ++j) {
      const std::int64_t product =
          std::int64_t{change[i]} * gain[j] + std::int64_t{change[j]} * gain[i];
      const auto spread = static_cast<std::int32_t>(
          clip3(-form.max_spread, form.max_spread,
                filter.spread[i * stride + j] - round2(product, shifts.spreading)));
      filter.spread[i * stride + j] = filter.spread[j * stride + i] = spread;
    }
    std::int32_t& own = filter.spread[i * stride + i];
    own = std::clamp(own + filter.walk[i], 1, form.max_spread);
  }
}

}  // namespace

void adapt(const FilterState& filter, const std::int32_t* offsets, std::int64_t error) {
  adapt_filter(kFactorFilter, filter, offsets, error, [](int) { return kFactorNoise; });
}

void adapt_to_frame(const FilterState& filter, const std::int32_t* offsets, std::int64_t error,
                    std::int64_t variance) {
  adapt_filter(kFrameFilter, filter, offsets, error,
               [&](int shift) { return frame_noise(variance, shift); });
}

}  // namespace rlpc
