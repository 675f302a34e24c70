// Models and context of a residual (clause 9.5): a signed integer whose expected magnitude is
// estimated from its neighbourhood.
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/bits/bit_model.h"

namespace rlpc {

inline constexpr int kResidualContexts = 9;
inline constexpr int kResidualPrefix = 14;     // longest adaptive unary prefix
inline constexpr int kResidualMaxEscape = 27;  // longest unary part of the escape code

// Magnitudes are clipped to this (clause 9.5.1), so that residuals fit 29 bits.
inline constexpr std::uint64_t kMaxResidual = (1U << 28) - 1;

struct ResidualModels {
  std::array<std::array<BitModel, kResidualPrefix>, kResidualContexts> prefix;
  std::array<std::array<BitModel, 3>, kResidualContexts> low;  // [context][Min(prefix, 2)]
};

struct ResidualContext {
  int index;  // 0 .. kResidualContexts - 1
  int shift;  // low bits that are not part of the prefix
};

// Table 9-1: context index of an expected magnitude below 3, in 1/16.
inline constexpr auto kResidualContextIndex = [] {
  constexpr std::array<int, 6> kFirst{2, 4, 8, 14, 22, 32};
  std::array<std::uint8_t, 48> index{};
  for (std::size_t e = 0; e < 48; ++e) {
    for (const int first : kFirst) {
      if (static_cast<int>(e) >= first) ++index[e];
    }
  }
  return index;
}();

// 9.5.2 ResidualContext( expected ): the expected magnitude has 4 fractional bits.
constexpr ResidualContext residual_context(std::uint32_t expected) {
  int shift = 0;
  while (expected >= 48) {
    expected >>= 1;
    ++shift;
  }
  if (shift == 0) return {kResidualContextIndex[expected], 0};
  return {expected < 34 ? 7 : 8, shift};
}

constexpr std::uint32_t magnitude_of(std::int32_t residual) {
  return static_cast<std::uint32_t>(residual < 0 ? -residual : residual);
}

// 9.5.3 UpdateMean( mean, magnitude, rate ): running mean of magnitudes with 8 fractional bits;
// its memory is about 2^rate values.
constexpr std::uint32_t update_mean(std::uint32_t mean, std::uint32_t magnitude, int rate) {
  const std::uint32_t target = (magnitude < 0x100000 ? magnitude : 0x100000) << 8;
  return target >= mean ? mean + ((target - mean) >> rate) : mean - ((mean - target) >> rate);
}

}  // namespace rlpc
