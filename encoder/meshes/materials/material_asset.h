// Materials of OBJ files as the asset of a stream.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/meshes/source_attribute.h"
#include "encoder/meshes/source_images.h"

namespace rlpc {

struct MaterialAsset {
  std::string glb;                 // empty: nothing to keep
  std::vector<std::string> files;  // images that were read
  std::vector<std::string> notes;  // about images and parameters that are not kept
};

// Returns an upper bound of the memory for make_material_asset() without images. Takes time
// linear in the number of names.
std::uint64_t material_asset_bytes(const SourceMaterials& materials);

// Makes an asset with the names of materials and parts and, for materials that the .mtl text
// describes, base colour, opacity, emission, roughness and metalness in the terms of glTF, and
// the images for these and for normals. folder: that of the mesh; images elsewhere are not
// read. images: what becomes of them. max_bytes: limit of all images.
MaterialAsset make_material_asset(const SourceMaterials& materials, const std::string& folder,
                                  Images images, std::uint64_t max_bytes);

}  // namespace rlpc
