// The nodes of a glTF document at a time of a clip.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "encoder/input/gltf/clip.h"
#include "encoder/input/gltf/document/affine.h"
#include "encoder/input/gltf/document/document.h"
#include "encoder/input/gltf/scene.h"

namespace rlpc {

struct GltfPose {
  std::vector<Affine> to_scene;  // of each node
  // For nodes whose weights the clip animates: [num_targets] of their meshes.
  std::map<std::uint32_t, std::vector<double>> weights;
};

// The pose of the document, moved by the clip; null: not moved.
GltfPose pose_of(const std::vector<GltfNode>& nodes, const GltfScene& scene,
                 const GltfClip* clip, double time);

}  // namespace rlpc
