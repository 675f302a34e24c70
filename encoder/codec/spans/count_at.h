// Numbers of bones or clusters that are compared.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rlpc {

// Returns 1, 2, 3, 4, 6, 8, 12, 16, 24 ...: two per octave, as the cost changes little in
// between.
constexpr std::uint32_t count_at(std::size_t i) {
  if (i % 2 == 1) return 1U << ((i + 1) / 2);
  return i == 0 ? 1 : 3U << (i / 2 - 1);
}
static_assert(count_at(0) == 1 && count_at(1) == 2 && count_at(2) == 3 && count_at(5) == 8 &&
              count_at(12) == 96);

}  // namespace rlpc
