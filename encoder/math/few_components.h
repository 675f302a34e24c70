// The leading principal components of a large matrix, without its Gram matrix.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "encoder/math/principal_components.h"

namespace rlpc {

// The components with energy above min_energy, at most max_components, by subspace iteration
// from a fixed start (Halko, Martinsson and Tropp 2011). None if there are too many of them for
// this to be faster. `energy` ends with the first value that is not above min_energy, and
// total_energy is not set.
//
//   matrix  [num_values][num_frames]
std::optional<ComponentsByRow> few_components(std::span<const float> matrix,
                                              std::size_t num_frames,
                                              std::size_t max_components, double min_energy);

}  // namespace rlpc
