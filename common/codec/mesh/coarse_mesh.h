// The meshes that remain when the highest vertex layers have been removed (clause 8.9.8).
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/vertex_layers.h"
#include "common/memory/owned.h"

namespace rlpc {

struct CoarseMesh {
  Vector<std::uint32_t> vertices;  // in decoded order; sorted by their output order
  Vector<Triangle> triangles;      // indices in `vertices`
};

struct MeshSize {
  std::uint32_t num_vertices = 0;
  std::uint32_t num_triangles = 0;
  bool operator==(const MeshSize&) const = default;
};

// All coarse meshes of a mesh.
class CoarseMeshes {
 public:
  // As for make_layers(): triangles in decoded order, read during the call. Makes the layers
  // once more; beyond the memory for that, at most 150 bytes for each triangle.
  CoarseMeshes(std::uint32_t num_vertices, std::span<const Triangle> triangles);
  // The same for triangles in output order (8.6.1). output_index: VertexOrder or empty.
  static CoarseMeshes of_output(std::uint32_t num_vertices, std::span<const Triangle> triangles,
                                std::span<const std::uint32_t> output_index);

  std::uint32_t num_layers() const { return num_layers_; }
  // LayerOfVertex, in decoded order.
  std::span<const std::uint8_t> layer_of_vertex() const { return layer_of_vertex_; }
  // 8.9.8 Coarse meshes. num_layers: at least 1; with as many as there are, or more, the whole
  // mesh without its degenerate triangles. output_index: VertexOrder or empty.
  CoarseMesh mesh(std::uint32_t num_layers,
                  std::span<const std::uint32_t> output_index = {}) const;
  MeshSize size(std::uint32_t num_layers) const;

 private:
  std::uint32_t num_layers_ = 1;
  Vector<std::uint8_t> layer_of_vertex_;  // [num_vertices]
  LayeredTriangles triangles_;
};

}  // namespace rlpc
