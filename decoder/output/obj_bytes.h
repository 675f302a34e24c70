// Formats frames as OBJ files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "decoder/output/mesh_bytes.h"
#include "decoder/output/obj_materials.h"

namespace rlpc {

class ObjBytes : public MeshBytes {
 public:
  ObjBytes(const SinkOptions& options, const std::string& materials);
  const std::string& frame(std::span<const std::int32_t> positions) override;

 private:
  void append_uv();
  void append_faces(const ObjMaterials& materials);
  void append_vertices();
  void append_normals();

  const SinkOptions& options_;
  MeshAttributes attributes_;
  MeshNormals normals_;
  std::vector<float> colours_;  // [vertex][colour_width_], or empty
  std::size_t colour_width_ = 0;
  std::vector<float> xyz_;
  std::string header_;  // with texture coordinates
  std::string faces_;
  std::string bytes_;
};

}  // namespace rlpc
