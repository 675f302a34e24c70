// Parts of a stream's asset that no glTF file may have.
#pragma once

#include <string>
#include <vector>

#include "decoder/meshes/stream_asset.h"

namespace rlpc {

// Replaces elements of lists that are no objects by empty objects, so that others keep their
// numbers, and removes references to textures, images and samplers that are not there. Returns
// the places, "materials[1]", of the first of them; empty: all is good. root: an object whose
// used members are arrays. Cost: linear in the asset.
std::vector<std::string> repair_asset(GltfJson& root);

}  // namespace rlpc
