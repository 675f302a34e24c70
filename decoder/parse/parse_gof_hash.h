// 6.7 GOF hash, parsing side.
#pragma once

#include <cstdint>
#include <vector>

#include "common/bitstream/bit_reader.h"
#include "common/result.h"

namespace rlpc {

struct GofHash {
  bool per_frame_flag = false;
  std::vector<std::uint32_t> position_crc;  // one per frame, or one for the GOF
};

// num_frames: of the GOF that the unit follows.
Result<GofHash> parse_gof_hash(BitReader& r, std::uint32_t num_frames);

}  // namespace rlpc
