// 6.9 GOF index, parsing side.
#pragma once

#include <cstdint>
#include <vector>

#include "common/bitstream/bit_reader.h"
#include "common/result.h"

namespace rlpc {

struct GofLocation {
  std::uint64_t offset = 0;  // of the GOF unit, bytes from the start of the stream
  std::uint32_t first_frame = 0;
};

// num_frames: of the sequence. Offsets are not checked against the units here.
Result<std::vector<GofLocation>> parse_gof_index(BitReader& r, std::uint32_t num_frames);

}  // namespace rlpc
