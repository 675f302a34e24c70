// Repairs parts of the asset of a stream that are invalid in glTF files.
#pragma once

#include <string>
#include <vector>

#include "decoder/meshes/stream_asset.h"

namespace rlpc {

// Replaces list elements that are not objects by empty objects, so that others keep their
// numbers, and removes references to missing textures, images and samplers. Returns the first
// places that it changed, such as "materials[1]"; empty if the asset is valid. root: an object
// whose used members are arrays. Cost: linear in the asset.
std::vector<std::string> repair_asset(GltfJson& root);

}  // namespace rlpc
