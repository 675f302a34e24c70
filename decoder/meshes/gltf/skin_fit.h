// Fits places of joints in frames for which the stream has none: GOFs with other bones, or no
// bones.
#pragma once

#include <vector>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/skeleton.h"
#include "decoder/meshes/gltf/skin_joints.h"
#include "decoder/meshes/gltf/skin_shape.h"

namespace rlpc {

// Sets empty places to those that fit their frame best. places: [frame][joint], at least one
// frame of which is not empty.
void fit_places(const Skeleton& skeleton, const Grid& grid, const SkinInfluences& influences,
                ShownFrames frames, std::vector<JointPlaces>& places);

}  // namespace rlpc
