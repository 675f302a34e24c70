// The nodes of a glTF document as trees, and those in the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/input/gltf/document/document.h"

namespace rlpc {

struct GltfScene {
  std::vector<std::optional<std::uint32_t>> parent;  // of each node
  std::vector<std::uint32_t> parents_first;          // all nodes
  std::vector<std::uint32_t> with_mesh;  // nodes of the scene, each before its children
};

// Errors: a node with two parents, a cycle, a scene that does not begin at roots.
GltfScene read_gltf_scene(const GltfDocument& document, GltfErrors& errors);

}  // namespace rlpc
