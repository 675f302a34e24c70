// Meshes without the highest vertex layers (clause 8.9.8).
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/vertex_layers.h"
#include "common/memory/owned.h"

namespace rlpc {

struct CoarseMesh {
  Vector<std::uint32_t> vertices;  // indices in decoded order, sorted by output order
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
  // triangles: in decoded order, read during the call. Makes the layers again (make_layers());
  // takes the memory for that, and at most 150 bytes per triangle.
  CoarseMeshes(std::uint32_t num_vertices, std::span<const Triangle> triangles);
  // Makes coarse meshes of triangles in output order (8.6.1). output_index: VertexOrder or
  // empty.
  static CoarseMeshes from_output(std::uint32_t num_vertices,
                                  std::span<const Triangle> triangles,
                                  std::span<const std::uint32_t> output_index);

  std::uint32_t num_layers() const { return num_layers_; }
  // LayerOfVertex, in decoded order.
  std::span<const std::uint8_t> layer_of_vertex() const { return layer_of_vertex_; }
  // 8.9.8 Coarse meshes. num_layers: at least 1; the number of layers or more: the whole mesh
  // without degenerate triangles. output_index: VertexOrder or empty.
  CoarseMesh mesh(std::uint32_t num_layers,
                  std::span<const std::uint32_t> output_index = {}) const;
  MeshSize size(std::uint32_t num_layers) const;

 private:
  std::uint32_t num_layers_ = 1;
  Vector<std::uint8_t> layer_of_vertex_;  // [num_vertices]
  LayeredTriangles triangles_;
};

}  // namespace rlpc
