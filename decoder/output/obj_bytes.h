// Formats frames as OBJ files.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
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
  bool holds(const AttributeSet& set) const override;

 private:
  // Texture coordinates of some materials.
  struct UvList {
    ObjTexture texture;
    const AttributeSet* set = nullptr;
    std::uint64_t first = 0;  // number of its first `vt`, counted from 1
  };
  // Of a triangle. Null: it has none.
  const UvList* uv_of(const ObjMaterials& materials, std::size_t triangle);
  // The index of their list.
  std::optional<std::size_t> add_uv(const ObjTexture& texture);
  // Each part at once, and within it each material: importers make an object of every `g` line
  // and a draw call of every `usemtl` line.
  std::vector<std::size_t> triangles_by_part() const;
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
  std::vector<UvList> uv_lists_;
  std::map<std::uint32_t, std::optional<std::size_t>> uv_list_of_material_;
  std::uint64_t num_uv_ = 0;
  std::string faces_;
  std::string bytes_;
};

}  // namespace rlpc
