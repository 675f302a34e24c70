// A section (9.3) bin by bin, including ones that no writer produces, for tests of parsers.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/codec/bits/bit_model.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/bits/range_encoder.h"
#include "common/codec/bits/residual_models.h"

namespace rlpc {

class SectionRecipe {
 public:
  RangeEncoder section;

  // 9.5.1
  void residual(ResidualModels& m, std::uint32_t expected, std::int32_t value) {
    const ResidualContext ctx = residual_context(expected);
    const auto index = static_cast<std::size_t>(ctx.index);
    const std::uint32_t high = magnitude_of(value) >> ctx.shift;
    const std::uint32_t prefix = std::min<std::uint32_t>(high, kResidualPrefix);
    for (std::uint32_t i = 0; i < prefix; ++i) section.bin(m.prefix[index][i], true);
    if (prefix < kResidualPrefix) {
      section.bin(m.prefix[index][prefix], false);
    } else {
      const std::uint32_t escape = high - kResidualPrefix + 1;
      for (int i = 0; i < floor_log2(escape); ++i) section.bypass(1, 1);
      section.bypass(1, 0);
      section.bypass(floor_log2(escape), escape - (1U << floor_log2(escape)));
    }
    if (ctx.shift > 0) {
      const std::uint32_t low = magnitude_of(value) & ((1U << ctx.shift) - 1);
      section.bin(m.low[index][std::min(prefix, 2U)], (low >> (ctx.shift - 1)) != 0);
      section.bypass(ctx.shift - 1, low & ((1U << (ctx.shift - 1)) - 1));
    }
    if (value != 0) section.bypass(1, value < 0 ? 1U : 0U);
  }
  // 9.5.4: a difference.
  void header_delta(ResidualModels& models, std::uint32_t& mean, std::int32_t delta) {
    residual(models, mean >> 4, delta);
    mean = update_mean(mean, magnitude_of(delta), 2);
  }
  // 9.5.5
  template <std::size_t N>
  void truncated_unary(std::array<BitModel, N>& models, std::size_t value) {
    for (std::size_t i = 0; i < value; ++i) section.bin(models[i], true);
    if (value < N) section.bin(models[value], false);
  }
};

}  // namespace rlpc
