// --frame-pattern of rlpcenc.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/codec/kinds/inter/frame_order.h"

namespace rlpc {

// "previous", "first", "dyadic:16", or entries such as "2<0,1<0+2@1", not checked otherwise.
// None: it is none of these.
std::optional<FramePattern> parse_frame_pattern_text(std::string_view text);
// The reverse.
std::string frame_pattern_text(const FramePattern& pattern);

}  // namespace rlpc
