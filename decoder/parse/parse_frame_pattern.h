// 6.14.1 Frame pattern, parsing side.
#pragma once

#include "common/bitstream/bit_reader.h"
#include "common/frame_gof/frame_order.h"

namespace rlpc {

// Errors are left in `r`.
FramePattern parse_frame_pattern(BitReader& r);

}  // namespace rlpc
