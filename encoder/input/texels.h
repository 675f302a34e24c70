// How many texels texture coordinates address, by the images of an asset.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rlpc {

// Texels along the unit of texture coordinates, of their longer side, for each set uv0, uv1,
// ...: of the largest image that the materials of `asset` (a GLB, 7.16; empty: none) address
// with it. 0: none does; infinity: one of an unknown size, as of other types than PNG and JPEG.
std::vector<double> texels_of_uv(std::string_view asset);

}  // namespace rlpc
