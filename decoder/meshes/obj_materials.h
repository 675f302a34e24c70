// Materials of OBJ files: their names, and the .mtl file and images next to them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "decoder/meshes/companion_file.h"
#include "decoder/meshes/frame_sink.h"
#include "decoder/meshes/stream_asset.h"

namespace rlpc {

// Texture coordinates of the image of a material, and their transform (KHR_texture_transform),
// which OBJ files apply to the coordinates of corners.
struct ObjTexture {
  std::uint32_t set = 0;                           // number of the set: 0 for uv0
  std::array<std::array<double, 3>, 2> rows = {};  // matrix for (u, v, 1), v pointing down
  bool operator==(const ObjTexture&) const = default;
};

class ObjMaterials {
 public:
  explicit ObjMaterials(const SinkOptions& options);

  // Returns whether triangles without numbers have a material, the first one.
  bool has_one() const { return has_one_; }
  // Return names for `usemtl` and `g`: from the asset of the stream, otherwise numbered.
  std::string material_name(std::uint32_t number) const;
  std::string part_name(std::uint32_t number) const;
  // Returns the texture of the base colour of a material or, if that has no image, of its
  // emission or normal.
  ObjTexture texture(std::uint32_t number) const;
  // Returns stem.mtl, with the materials that triangles use, and the images that it names;
  // empty if they use none.
  std::vector<CompanionFile> files(const std::string& stem) const;

 private:
  class Images;
  std::string mtl_of(std::uint32_t number, Images& images) const;

  StreamAsset asset_;
  std::vector<std::uint32_t> used_;  // ascending
  bool has_one_ = false;
};

}  // namespace rlpc
