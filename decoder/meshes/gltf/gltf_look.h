// Look of a glTF mesh: values of its vertices, normals, materials and textures.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/mesh.h"
#include "decoder/meshes/gltf/glb_buffers.h"
#include "decoder/meshes/gltf/glb_mesh.h"
#include "decoder/surface/drawn_mesh.h"

namespace rlpc {

class GltfLook {
 public:
  // Sets and triangles of the stream must outlive it. asset: as in the stream (7.16); empty:
  // none.
  GltfLook(const std::vector<AttributeSet>& sets, std::span<const Triangle> triangles,
           std::uint32_t num_vertices, const std::string& asset);

  // Returns the mesh: vertices are split where their values differ, with a part for each
  // material of each part of the stream.
  const GlbMesh& mesh() const { return mesh_; }
  // Adds texture coordinates and colours to the attributes of the primitives.
  void add_values(GltfJson& attributes, GlbBuffers& buffers) const;
  bool has_normals() const { return drawn_->has_normals(); }
  // Computes the normals of output vertices, if has_normals(). xyz: vertices of the stream.
  std::vector<float> normals(std::span<const float> xyz) const;
  // Computes the normals on any thread. normals_of_frames: a copy of frame_normals(); if it is
  // restricted, the normals that it omits are undefined.
  std::vector<float> normals(FrameNormals& normals_of_frames, std::span<const float> xyz) const;
  const FrameNormals& frame_normals() const { return drawn_->normals(); }
  // Returns the index in frame_normals() of the normal of each output vertex.
  std::span<const std::uint32_t> normal_of_vertex() const { return drawn_->normal_of_vertex(); }
  // Adds materials, textures, images and samplers.
  void add_materials(GltfJson& root, GlbBuffers& buffers) const;
  // Returns why the asset was left out; empty if it was not.
  const std::string& problem() const { return asset_.problem(); }

 private:
  struct Values {
    std::size_t set = 0;         // index in the drawn sets
    std::uint32_t width = 2;     // components
    std::vector<float> numbers;  // [output vertex][width]
  };

  std::map<std::uint32_t, std::uint32_t> equal_uvs() const;
  void add_images(GltfJson& images, GlbBuffers& buffers) const;
  void make_parts(const std::vector<AttributeSet>& sets, std::span<const Triangle> triangles);

  StreamAsset asset_;
  std::unique_ptr<DrawnMesh> drawn_;
  GlbMesh mesh_;
  std::map<std::uint32_t, Values> uvs_;  // key: number of the set, 0 for uv0
  std::map<std::uint32_t, Values> colours_;
};

}  // namespace rlpc
