// Formats frames as OBJ files.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "decoder/meshes/mesh_bytes.h"
#include "decoder/meshes/obj_materials.h"

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
    // Number of its first `vt`, counted from 1, if it has all values of the set. One list of
    // each set has them; others have the values that corners use, as every material may have a
    // list.
    std::optional<std::uint64_t> first;
    std::unordered_map<std::uint32_t, std::uint64_t> numbers;  // number of the `vt` by value
  };
  // Returns the list of a triangle; null if it has none.
  UvList* uv_of(const ObjMaterials& materials, std::size_t triangle);
  // Returns the index of the list of a texture.
  std::optional<std::size_t> add_uv(const ObjTexture& texture);
  // Returns the number of the `vt` of a value.
  std::uint64_t number_of(UvList& list, std::uint32_t value);
  void append_uv(const UvList& list, std::uint32_t value);
  // Returns the triangles sorted by part, then by material: importers make an object of every
  // `g` line and a draw call of every `usemtl` line.
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
  std::string header_;  // header with texture coordinates
  std::vector<UvList> uv_lists_;
  std::map<std::array<std::uint64_t, 7>, std::size_t> list_of_texture_;  // key: texture bits
  std::map<const AttributeSet*, std::vector<float>> uv_of_set_;
  std::map<std::uint32_t, std::optional<std::size_t>> uv_list_of_material_;
  std::uint64_t num_uv_ = 0;
  std::string faces_;
  std::string bytes_;
};

}  // namespace rlpc
