// 6.15 Clip table, parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/mesh/clip.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/parse/memory_limit.h"

namespace rlpc {

// 6.15 clip_table( ). num_frames: frames of the sequence, or kMaxFrames if unknown. Names are
// not checked (R-CLP-03). Memory is proportional to the payload.
Result<Vector<Clip>> parse_clip_table(BitReader& r, std::uint32_t num_frames,
                                      const MemoryLimit& memory);

}  // namespace rlpc
