// The node hierarchy of a glTF document, and the nodes of its scene.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/meshes/gltf/document/document.h"

namespace rlpc {

struct GltfScene {
  std::vector<std::optional<std::uint32_t>> parent;  // [node]
  std::vector<std::uint32_t> parents_first;          // all nodes, parents before children
  std::vector<std::uint32_t> with_mesh;              // nodes with a mesh, in the same order
};

// Errors: a node with two parents, a cycle, a scene that lists a node with a parent.
GltfScene read_gltf_scene(const GltfDocument& document, GltfErrors& errors);

}  // namespace rlpc
