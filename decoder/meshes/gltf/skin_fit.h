// Places of joints in frames for which the stream has none: those of groups of frames that have
// other bones, or no bones.
#pragma once

#include <vector>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/skeleton.h"
#include "decoder/meshes/gltf/skin_joints.h"
#include "decoder/meshes/gltf/skin_shape.h"

namespace rlpc {

// Sets the places that are empty to those that fit the frame best; places [frame][joint], of
// which at least one is there.
void fit_places(const Skeleton& skeleton, const Grid& grid, const SkinInfluences& influences,
                ShownFrames frames, std::vector<JointPlaces>& places);

}  // namespace rlpc
