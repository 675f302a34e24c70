#include "decoder/codec/gofs/coarse_output.h"

#include <utility>

#include "common/codec/mesh/coarse_mesh.h"

namespace rlpc {

CoarseOutput::CoarseOutput(std::uint32_t num_vertices, std::span<const Triangle> triangles,
                           std::span<const std::uint32_t> vertex_order, std::uint32_t layers) {
  const auto meshes = CoarseMeshes::from_output(num_vertices, triangles, vertex_order);
  CoarseMesh mesh = meshes.mesh(layers, vertex_order);
  num_layers_ = meshes.num_layers();
  decoded_ = std::move(mesh.vertices);
  triangles_ = std::move(mesh.triangles);
  vertices_ = decoded_;
  if (vertex_order.empty()) return;
  for (std::uint32_t& v : vertices_) v = vertex_order[v];
}

}  // namespace rlpc
