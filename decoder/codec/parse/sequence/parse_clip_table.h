// 6.15 Clip table, parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/mesh/clip.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/parse/memory_limit.h"

namespace rlpc {

// num_frames: of the sequence, as far as it is known. Names are not checked (R-CLP-03). Memory
// is in proportion to the payload.
Result<Vector<Clip>> parse_clip_table(BitReader& r, std::uint32_t num_frames,
                                      const MemoryLimit& memory);

}  // namespace rlpc
