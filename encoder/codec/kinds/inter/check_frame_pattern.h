// Checks the pattern of inter GOFs (7.14.1).
#pragma once

#include <optional>
#include <string>

#include "common/codec/kinds/inter/frame_order.h"

namespace rlpc {

// Returns what is wrong with the pattern; none: it is legal.
std::optional<std::string> error_of_pattern(const FramePattern& pattern);

}  // namespace rlpc
