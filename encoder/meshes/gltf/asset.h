// What a viewer needs of a glTF document besides its meshes: materials, textures, names of
// parts.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/document/buffers.h"
#include "encoder/meshes/gltf/document/file.h"
#include "encoder/meshes/gltf/model.h"

namespace rlpc {

struct GltfAsset {
  // A GLB without geometry, whose nodes have the names of the parts of the mesh; empty: there
  // is nothing to keep.
  std::string glb;
  std::vector<std::string> notes;  // about what could not be read
  std::vector<std::string> files;  // of images
};

// root: the document, valid. Images come into the binary chunk, wherever they were; without
// textures, materials lose those. Memory: counted; exceeding the limit is an error there.
GltfAsset make_gltf_asset(const nlohmann::json& root, const GltfModel& model, GltfFile& file,
                          bool textures, GltfMemory& memory);

}  // namespace rlpc
