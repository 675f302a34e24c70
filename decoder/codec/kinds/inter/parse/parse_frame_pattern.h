// 6.14.1 Frame pattern, parsing side.
#pragma once

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/inter/frame_order.h"

namespace rlpc {

// 6.14.1 frame_pattern( ). Errors are left in `r`.
FramePattern parse_frame_pattern(BitReader& r);

}  // namespace rlpc
