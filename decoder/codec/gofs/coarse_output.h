// 8.9.8 Coarse meshes: the coarse mesh of a stream in output order, and its positions.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

class CoarseOutput {
 public:
  // triangles: the whole mesh, in output order; vertex_order: as in the stream (8.6.1), empty
  // if it has none; layers: number to keep, at least 1. Spans are read only during the call.
  CoarseOutput(std::uint32_t num_vertices, std::span<const Triangle> triangles,
               std::span<const std::uint32_t> vertex_order, std::uint32_t layers);

  std::uint32_t num_layers() const { return num_layers_; }  // layers of the whole mesh
  // Returns output indices in the whole mesh, ascending.
  std::span<const std::uint32_t> vertices() const { return vertices_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  // Returns the decoded index of each of vertices().
  std::span<const std::uint32_t> decoded() const { return decoded_; }

 private:
  std::uint32_t num_layers_ = 1;
  Vector<std::uint32_t> decoded_;   // decoded indices, in output order
  Vector<std::uint32_t> vertices_;  // [as decoded_]
  Vector<Triangle> triangles_;
};

}  // namespace rlpc
