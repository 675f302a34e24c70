// Formats frames as PLY files, in which vertices are split by their attributes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "decoder/meshes/mesh_bytes.h"
#include "decoder/surface/split_vertices.h"

namespace rlpc {

// Texture coordinates are the properties s and t of vertices, which Blender and MeshLab read.
// Lists of texture coordinates in faces, which would not split vertices, only MeshLab reads.
class PlyBytes : public MeshBytes {
 public:
  explicit PlyBytes(const SinkOptions& options);
  const std::string& frame(std::span<const std::int32_t> positions) override;
  bool holds(const AttributeSet& set) const override;

 private:
  // Values of a set, and the index of the value of each vertex.
  struct Values {
    std::vector<float> numbers;
    std::size_t width = 0;
    std::vector<std::uint32_t> value_of_vertex;
  };

  void split();
  void append_header();
  void append_faces();
  void append_vertex(std::uint32_t vertex, std::span<const float> normals);
  void append(float x);

  const SinkOptions& options_;
  MeshAttributes attributes_;
  MeshNormals normals_;
  SplitVertices vertices_;
  std::vector<std::uint32_t> normal_of_vertex_;
  Values uv_;
  Values colours_;
  std::vector<float> xyz_;  // vertices of the stream
  std::string header_;
  std::string faces_;
  std::string bytes_;
};

}  // namespace rlpc
