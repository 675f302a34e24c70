// 6.11 layer_groups( ) and layer_steps( ): the layers of a rig or inter GOF.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/memory/owned.h"

namespace rlpc {

// Returns the number of layers of each group, which together have all layers; empty if reading
// has stopped.
inline Vector<std::uint32_t> parse_layer_groups(BitReader& r, std::uint32_t num_layers) {
  const std::uint32_t num_groups =
      r.ue("num_layer_groups_minus1", {0, std::int64_t{num_layers} - 1}, "R-BON-03",
           AfterBroken::kStop) +
      1;
  if (r.stopped()) return {};
  Vector<std::uint32_t> sizes(num_groups, 1);
  std::int64_t left = num_layers;
  for (std::uint32_t j = 0; j + 1 < num_groups; ++j) {
    const std::int64_t groups_after = num_groups - j - 1;
    sizes[j] = r.ue("layer_group_layers_minus1", {0, left - groups_after - 1}, "R-BON-03",
                    AfterBroken::kStop) +
               1;
    left -= sizes[j];
  }
  if (r.stopped()) return {};
  sizes.back() = static_cast<std::uint32_t>(left);
  return sizes;
}

inline void parse_layer_steps(BitReader& r, Vector<std::uint8_t>& steps) {
  for (std::uint8_t& step : steps) {
    step = static_cast<std::uint8_t>(r.u(4, "layer_step_minus1") + 1);
  }
}

}  // namespace rlpc
