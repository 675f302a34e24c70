// The materials of OBJ files: their names, and the .mtl file and images beside them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decoder/output/companion_file.h"
#include "decoder/output/frame_sink.h"
#include "decoder/output/stream_asset.h"

namespace rlpc {

class ObjMaterials {
 public:
  explicit ObjMaterials(const SinkOptions& options);

  // Whether triangles without numbers have a material, the first.
  bool has_one() const { return has_one_; }
  // Of `usemtl` and `g`: from the asset of the stream, otherwise numbered.
  std::string material_name(std::uint32_t number) const;
  std::string part_name(std::uint32_t number) const;
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
