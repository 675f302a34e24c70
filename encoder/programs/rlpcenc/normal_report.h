// Reports of rlpcenc about the normals of a stream.
#pragma once

#include <optional>
#include <string>

#include "encoder/rlpc_encoder.h"

namespace rlpc {

// Returns how normals are coded, and their errors in the first, the middle and the worst frame.
std::string normal_text(const AttributeReport& normals);
// Returns a warning if the normals of a frame are far off on average; otherwise none.
std::optional<std::string> normal_warning(const AttributeReport& normals);

}  // namespace rlpc
