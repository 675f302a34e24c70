// 9.5 Residuals, parsing side.
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/codec/bits/range_decoder.h"
#include "common/codec/bits/residual_models.h"

namespace rlpc {

// 9.5.1 ae_residual( models, expected )
inline std::int32_t parse_residual(RangeDecoder& rd, ResidualModels& models,
                                   std::uint32_t expected) {
  const ResidualContext ctx = residual_context(expected);
  auto& prefix_models = models.prefix[static_cast<std::size_t>(ctx.index)];
  std::uint32_t prefix = 0;
  while (prefix < kResidualPrefix && rd.bin(prefix_models[prefix])) ++prefix;
  std::uint64_t magnitude = prefix;
  if (prefix == kResidualPrefix) {
    int length = 0;
    while (length < kResidualMaxEscape && rd.bypass(1) != 0) ++length;
    magnitude += (std::uint32_t{1} << length) - 1 + rd.bypass(length);
  }
  if (ctx.shift > 0) {
    auto& low_models = models.low[static_cast<std::size_t>(ctx.index)];
    const bool low_top = rd.bin(low_models[std::min<std::uint32_t>(prefix, 2)]);
    magnitude = (magnitude << 1) | static_cast<std::uint64_t>(low_top);
    const int rest = ctx.shift - 1;
    magnitude = (magnitude << rest) | rd.bypass(rest);
  }
  magnitude = std::min(magnitude, kMaxResidual);
  if (magnitude == 0) return 0;
  const auto value = static_cast<std::int32_t>(magnitude);
  return rd.bypass(1) != 0 ? -value : value;
}

}  // namespace rlpc
