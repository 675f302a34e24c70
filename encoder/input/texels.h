// What texture coordinates address, by the images of an asset.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "encoder/input/source_attribute.h"

namespace rlpc {

// For each set uv0, uv1, ... that the materials of `asset` (a GLB, 7.16; empty: none) use.
std::vector<UvUse> uses_of_uv(std::string_view asset);

}  // namespace rlpc
