#include "common/kernels/weight_filter.h"

#include <algorithm>

#include "common/int_math.h"

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

FilterShifts::FilterShifts(std::int64_t scale, std::uint32_t largest) {
  scale = std::max(scale, kMinScale);
  narrow = std::max(floor_log2(largest) - (kGainBits - 1), 0);
  const int exponent = floor_log2(static_cast<std::uint64_t>(scale)) - kGainBits;
  inverse =
      static_cast<std::int32_t>((std::int64_t{1} << (2 * kGainBits + 1)) / (scale >> exponent));
  weighting = std::clamp(exponent - narrow - 2, 0, 31);
  spreading = std::clamp(8 + exponent - 2 * narrow, 1, 31);
}

std::int64_t predict_offset(const WeightFilter& filter, const std::int32_t* offsets) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < filter.size; ++i) {
    sum += std::int64_t{filter.weight[i]} * offsets[i];
  }
  return round2(sum, kAdaptiveFractionBits);
}

void adapt(WeightFilter& filter, const std::int32_t* offsets, std::int64_t error) {
  const std::size_t n = filter.size;
  const std::size_t stride = filter.stride;
  std::uint32_t largest = 1;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, magnitude(offsets[i]));
  const int shift = std::max(floor_log2(largest) - kOffsetLog2, 0);
  const std::int64_t e =
      std::clamp<std::int64_t>(round2(error, shift), -kMaxFilterError, kMaxFilterError);
  std::array<std::int64_t, kMaxFilterSize> offset{};
  for (std::size_t i = 0; i < n; ++i) offset[i] = round2(offsets[i], shift);

  std::array<std::int32_t, kMaxFilterSize> gain{};
  std::int64_t scale = kMinScale;
  largest = 1;
  for (std::size_t i = 0; i < n; ++i) {
    std::int64_t sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += filter.spread[i * stride + j] * offset[j];
    gain[i] = static_cast<std::int32_t>(round2(sum, kGainShift));
    scale += gain[i] * offset[i];
    largest = std::max(largest, magnitude(gain[i]));
  }
  const FilterShifts shifts(scale, largest);
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
          clip3(-kMaxSpread, kMaxSpread,
                filter.spread[i * stride + j] - round2(product, shifts.spreading)));
      filter.spread[i * stride + j] = filter.spread[j * stride + i] = spread;
    }
    std::int32_t& own = filter.spread[i * stride + i];
    own = std::clamp(own + filter.walk[i], 1, kMaxSpread);
  }
}

}  // namespace rlpc
