// What glTF documents have that streams do not.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/model.h"

namespace rlpc {

// Names what the reader leaves out, in the words of users, once each: attributes, morph targets
// and what else belongs to meshes, nodes, extensions, extras. Materials and textures are kept;
// what GltfDocument::dropped has is not repeated. root: the document, valid where it is read.
std::vector<std::string> gltf_losses(const nlohmann::json& root, const GltfModel& model);

// What a channel that targets no property of a node animates, by its JSON pointer; empty: it
// has none.
std::string pointer_target(const std::string& pointer);

}  // namespace rlpc
