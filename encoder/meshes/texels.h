// Finds the images of an asset that texture coordinates address.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// Returns the uses of each set uv0, uv1, ... by the materials of `asset` (a GLB, 7.16; empty:
// none). max_memory_bytes: limit for its JSON as a tree; if it needs more, no use is known.
std::vector<UvUse> uses_of_uv(std::string_view asset, std::uint64_t max_memory_bytes);

}  // namespace rlpc
