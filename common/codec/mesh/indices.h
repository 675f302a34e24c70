// Lists of indices.
#pragma once

#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

// Sorts indices in ascending order and removes repetitions. Cost: n log n.
void sort_without_repetitions(Vector<std::uint32_t>& indices);

}  // namespace rlpc
