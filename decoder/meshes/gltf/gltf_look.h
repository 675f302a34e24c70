// What a glTF mesh looks like: values of its vertices, normals, materials and textures.
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
  // sets and triangles: of the stream, which must outlive it. asset: of the stream (7.16);
  // empty: none.
  GltfLook(const std::vector<AttributeSet>& sets, std::span<const Triangle> triangles,
           std::uint32_t num_vertices, const std::string& asset);

  // Vertices are split where their values differ; there is a part for each material and part of
  // the stream.
  const GlbMesh& mesh() const { return mesh_; }
  // Adds texture coordinates and colours to the attributes of the primitives.
  void add_values(GltfJson& attributes, GlbBuffers& buffers) const;
  bool has_normals() const { return drawn_->has_normals(); }
  // Of output vertices, if has_normals(). xyz: of the vertices of the stream.
  std::vector<float> normals(std::span<const float> xyz) const;
  // The same on a thread of its own. of_frames: a copy of frame_normals(); where it is
  // restricted, the others are undefined.
  std::vector<float> normals(FrameNormals& of_frames, std::span<const float> xyz) const;
  const FrameNormals& frame_normals() const { return drawn_->normals(); }
  // Index of the normal of each output vertex, among frame_normals().
  std::span<const std::uint32_t> normal_of_vertex() const { return drawn_->normal_of_vertex(); }
  // Sets materials, textures and what they need.
  void add_materials(GltfJson& root, GlbBuffers& buffers) const;
  // Why the asset was left out; empty: it was not.
  const std::string& problem() const { return asset_.problem(); }

 private:
  struct Values {
    std::size_t set = 0;         // of those drawn
    std::uint32_t width = 2;     // components
    std::vector<float> numbers;  // of output vertices
  };

  std::map<std::uint32_t, std::uint32_t> equal_uvs() const;
  void add_images(GltfJson& images, GlbBuffers& buffers) const;
  void make_parts(const std::vector<AttributeSet>& sets, std::span<const Triangle> triangles);

  StreamAsset asset_;
  std::unique_ptr<DrawnMesh> drawn_;
  GlbMesh mesh_;
  std::map<std::uint32_t, Values> uvs_;  // by their numbers
  std::map<std::uint32_t, Values> colours_;
};

}  // namespace rlpc
