// 8.16.1: Models, the skinned models that are kept while a stream is decoded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

// By model_idx; null: none. Copies share the models.
struct ModelSlots {
  std::array<std::shared_ptr<const SkinnedModel>, kMaxModels> of_idx;

  // FactorsOfModels( other ); kMaxModels: of all.
  std::uint64_t num_factors(std::size_t other) const {
    std::uint64_t sum = 0;
    for (std::size_t m = 0; m < of_idx.size(); ++m) {
      if (m != other && of_idx[m]) sum += rlpc::num_factors(*of_idx[m]);
    }
    return sum;
  }
};

}  // namespace rlpc
