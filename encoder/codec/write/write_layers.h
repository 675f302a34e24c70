// 6.11 layer_groups( ) and layer_steps( ), writing side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/bits/bit_writer.h"

namespace rlpc {

inline void write_layer_groups(BitWriter& w, std::span<const std::uint32_t> sizes) {
  w.ue(static_cast<std::uint32_t>(sizes.size() - 1));
  for (std::size_t j = 0; j + 1 < sizes.size(); ++j) w.ue(sizes[j] - 1);
}

inline void write_layer_steps(BitWriter& w, std::span<const std::uint8_t> steps) {
  for (const std::uint8_t step : steps) w.u(4, step - 1U);
}

}  // namespace rlpc
