// 8.16.1: Rigs, the shared rigs that are alive while a stream is decoded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

// Shared rigs by rig_idx; null: none. Copies share the rigs.
struct RigSlots {
  std::array<std::shared_ptr<const SharedRig>, kMaxRigs> slots;

  // FactorsOfRigs( other ); other = kMaxRigs: counts all rigs.
  std::uint64_t num_factors(std::size_t other) const {
    std::uint64_t sum = 0;
    for (std::size_t m = 0; m < slots.size(); ++m) {
      if (m != other && slots[m]) sum += rlpc::num_factors(*slots[m]);
    }
    return sum;
  }
};

}  // namespace rlpc
