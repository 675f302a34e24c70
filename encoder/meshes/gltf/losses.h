// Contents of glTF documents that streams cannot hold.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/model.h"

namespace rlpc {

// Names the contents that the reader leaves out, in the words of users, once each: attributes,
// morph targets and other parts of meshes, nodes, extensions, extras. Materials and textures
// are kept; GltfDocument::dropped is not repeated. root: the document, valid where it is read.
std::vector<std::string> gltf_losses(const nlohmann::json& root, const GltfModel& model);

// Names what a channel that targets no property of a node animates, by its JSON pointer; empty:
// no pointer.
std::string pointer_target(const std::string& pointer);

}  // namespace rlpc
