// Evaluates the nodes of a glTF document at a time of a clip.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "encoder/meshes/gltf/clip.h"
#include "encoder/meshes/gltf/document/affine.h"
#include "encoder/meshes/gltf/document/document.h"
#include "encoder/meshes/gltf/scene.h"

namespace rlpc {

struct GltfPose {
  std::vector<Affine> to_scene;  // [node], its map to scene coordinates
  // [node], only nodes whose weights are animated: [num_targets of the mesh].
  std::map<std::uint32_t, std::vector<double>> weights;
};

// Returns the pose at a time of the clip. clip: null for the pose without animation.
GltfPose pose_of(const std::vector<GltfNode>& nodes, const GltfScene& scene,
                 const GltfClip* clip, double time);

}  // namespace rlpc
