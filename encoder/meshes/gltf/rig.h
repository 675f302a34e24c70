// The rig of a glTF model: its joints, and the nodes that move meshes without a skin.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "encoder/meshes/gltf/model.h"
#include "encoder/meshes/gltf/pose.h"
#include "encoder/meshes/source_rig.h"

namespace rlpc {

struct GltfRig {
  struct Bone {
    std::uint32_t node = 0;
    Affine from_rest;  // from the rest shape to coordinates of the node
  };

  std::vector<Bone> bones;               // those of `rig`
  std::shared_ptr<const SourceRig> rig;  // vertices in the order of the scene; null: no rig
};

// Returns the rig of the model. All vertices have one rest shape, of about their size in the
// scene: meshes of other skins, and those that nodes move, are placed so that bones in common
// move them alike. poses: at least one; the first is that of the first frame, the others show
// nodes that are small in it. No rig: one bone moves everything, there are too many bones to be
// of use, or the rig would take more than max_memory_bytes.
GltfRig gltf_rig(const GltfModel& model, std::span<const GltfPose* const> poses,
                 std::uint64_t max_memory_bytes);

// Computes the maps of the bones in a pose.
void map_bones(const GltfRig& rig, const GltfPose& pose, std::span<BoneMap> maps);

}  // namespace rlpc
