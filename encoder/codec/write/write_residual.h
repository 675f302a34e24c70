// 9.5 Residuals, writing side.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "common/codec/bits/int_math.h"
#include "common/codec/bits/residual_models.h"

namespace rlpc {

// 9.5.1 ae_residual( models, expected ); |value| <= kMaxResidual. Coder: RangeEncoder, or a
// class of encoder/codec/write/bit_cost.h.
template <class Coder>
void write_residual(Coder& re, ResidualModels& models, std::uint32_t expected,
                    std::int32_t value) {
  const auto magnitude = static_cast<std::uint32_t>(value < 0 ? -value : value);
  assert(magnitude <= kMaxResidual);
  const ResidualContext ctx = residual_context(expected);
  const std::uint32_t high = magnitude >> ctx.shift;
  const std::uint32_t prefix = std::min<std::uint32_t>(high, kResidualPrefix);
  auto& prefix_models = models.prefix[static_cast<std::size_t>(ctx.index)];
  for (std::uint32_t i = 0; i < prefix; ++i) re.bin(prefix_models[i], true);
  if (prefix < kResidualPrefix) {
    re.bin(prefix_models[prefix], false);
  } else {
    const std::uint32_t escape = high - kResidualPrefix + 1;
    const int length = floor_log2(escape);
    assert(length <= kResidualMaxEscape);
    re.bypass(length, (std::uint32_t{1} << length) - 1);
    if (length < kResidualMaxEscape) re.bypass(1, 0);
    re.bypass(length, escape - (std::uint32_t{1} << length));
  }
  if (ctx.shift > 0) {
    auto& low_models = models.low[static_cast<std::size_t>(ctx.index)];
    const std::uint32_t low = magnitude & ((std::uint32_t{1} << ctx.shift) - 1);
    re.bin(low_models[std::min<std::uint32_t>(prefix, 2)],
           ((low >> (ctx.shift - 1)) & 1U) != 0);
    re.bypass(ctx.shift - 1, low & ((std::uint32_t{1} << (ctx.shift - 1)) - 1));
  }
  if (magnitude != 0) re.bypass(1, value < 0 ? 1U : 0U);
}

}  // namespace rlpc
