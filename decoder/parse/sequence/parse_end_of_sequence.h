// 6.8 End of sequence, parsing side.
#pragma once

#include <cstdint>

#include "common/bitstream/bit_reader.h"

namespace rlpc {

// index_distance: from the start of the GOF index to this unit, bytes; 0: there is no index.
inline std::uint32_t parse_end_of_sequence(BitReader& r) {
  const std::uint32_t index_distance = r.u(32, "index_distance");
  r.expect_end();
  return index_distance;
}

}  // namespace rlpc
