// The float value of a decoded position (clause 7.3), as decoders compute it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/mesh/mesh.h"

namespace rlpc {

// float((position + origin) * 2^log2_step). The sum has at most 28 bits and the power of two is
// exact, so the product is exact in double (its exponent stays within -150 to 147) and is
// rounded once, to float. -150 <= grid.log2_step <= 120.
inline float grid_value(const Grid& grid, std::size_t axis, std::int32_t position) {
  const auto power =
      std::bit_cast<double>(static_cast<std::uint64_t>(1023 + grid.log2_step) << 52);
  const std::int64_t steps = std::int64_t{position} + grid.origin[axis];
  return static_cast<float>(static_cast<double>(steps) * power);
}

}  // namespace rlpc
