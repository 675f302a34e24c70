// What rlpcenc says of the normals of a stream.
#pragma once

#include <optional>
#include <string>

#include "encoder/rlpc_encoder.h"

namespace rlpc {

// How they are coded, and their errors in the first, the middle and the worst frame.
std::string normal_text(const AttributeReport& normals);
// A warning if those of a frame are far off on average; none otherwise.
std::optional<std::string> normal_warning(const AttributeReport& normals);

}  // namespace rlpc
