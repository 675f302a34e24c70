// The materials of OBJ files: their names, and the .mtl file and images beside them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "decoder/meshes/companion_file.h"
#include "decoder/meshes/frame_sink.h"
#include "decoder/meshes/stream_asset.h"

namespace rlpc {

// Which texture coordinates the image of a material has, and where in it they lie
// (KHR_texture_transform): as all that OBJ files have are coordinates of corners, theirs differ
// from those of the stream.
struct ObjTexture {
  std::uint32_t set = 0;                           // of uv0, uv1, ...
  std::array<std::array<double, 3>, 2> rows = {};  // of (u, v, 1), v pointing down
  bool operator==(const ObjTexture&) const = default;
};

class ObjMaterials {
 public:
  explicit ObjMaterials(const SinkOptions& options);

  // Whether triangles without numbers have a material, the first.
  bool has_one() const { return has_one_; }
  // Of `usemtl` and `g`: from the asset of the stream, otherwise numbered.
  std::string material_name(std::uint32_t number) const;
  std::string part_name(std::uint32_t number) const;
  // Of its base colour; without an image of that, of its emission or normal.
  ObjTexture texture(std::uint32_t number) const;
  // stem.mtl, with the materials that triangles use, and the images that it names. Empty: they
  // use none.
  std::vector<CompanionFile> files(const std::string& stem) const;

 private:
  class Images;
  std::string mtl_of(std::uint32_t number, Images& images) const;

  StreamAsset asset_;
  std::vector<std::uint32_t> used_;  // ascending
  bool has_one_ = false;
};

}  // namespace rlpc
