// Reads and writes the argument of --frame-pattern of rlpcenc.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/codec/kinds/inter/frame_order.h"

namespace rlpc {

// Reads "previous", "first", "dyadic:16", or entries such as "2<0,1<0+2@1", whose numbers are
// not checked. None: it is none of these.
std::optional<FramePattern> parse_frame_pattern_text(std::string_view text);
// Returns the text of a pattern.
std::string frame_pattern_text(const FramePattern& pattern);

}  // namespace rlpc
