// The parts of a glTF document that viewers need besides meshes: materials, textures, names of
// parts.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/document/buffers.h"
#include "encoder/meshes/gltf/document/file.h"
#include "encoder/meshes/gltf/model.h"
#include "encoder/meshes/source_images.h"

namespace rlpc {

struct GltfAsset {
  // A GLB without geometry, whose nodes have the names of the parts of the mesh; empty: nothing
  // to keep.
  std::string glb;
  std::vector<std::string> notes;  // about data that could not be read
  std::vector<std::string> files;  // image files
};

// Makes the asset of a valid document. Images are moved into the binary chunk; without
// images, materials lose their textures. Exceeding the limit of `memory` is an error there.
GltfAsset make_gltf_asset(const nlohmann::json& root, const GltfModel& model, GltfFile& file,
                          Images images, GltfMemory& memory);

}  // namespace rlpc
