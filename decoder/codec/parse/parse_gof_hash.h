// 6.7 GOF hash, parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/syntax/gof_hash.h"
#include "common/result.h"

namespace rlpc {

// 6.7 gof_hash( ). num_frames: frames of the GOF that the unit belongs to.
Result<GofHash> parse_gof_hash(BitReader& r, std::uint32_t num_frames);

}  // namespace rlpc
