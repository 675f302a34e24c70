#include "common/codec/mesh/coarse_mesh.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

bool is_in(const LayeredTriangle& t, std::uint32_t num_layers) {
  return t.min_layers <= num_layers && num_layers <= t.max_layers;
}

}  // namespace

CoarseMeshes::CoarseMeshes(std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  VertexLayers layers = make_layers(num_vertices, triangles, &triangles_);
  num_layers_ = layers.num_layers;
  layer_of_vertex_ = std::move(layers.layer_of_vertex);
}

CoarseMeshes CoarseMeshes::from_output(std::uint32_t num_vertices,
                                       std::span<const Triangle> triangles,
                                       std::span<const std::uint32_t> output_index) {
  if (output_index.empty()) return {num_vertices, triangles};
  Vector<std::uint32_t> decoded(num_vertices);
  for (std::uint32_t v = 0; v < num_vertices; ++v) decoded[output_index[v]] = v;
  Vector<Triangle> in_decoded_order(triangles.begin(), triangles.end());
  for (Triangle& t : in_decoded_order) t = {decoded[t[0]], decoded[t[1]], decoded[t[2]]};
  return {num_vertices, in_decoded_order};
}

// 8.9.8 Coarse meshes
CoarseMesh CoarseMeshes::mesh(std::uint32_t num_layers,
                              std::span<const std::uint32_t> output_index) const {
  assert(num_layers > 0);
  assert(output_index.empty() || output_index.size() == layer_of_vertex_.size());
  num_layers = std::min(num_layers, num_layers_);
  const auto num_vertices = static_cast<std::uint32_t>(layer_of_vertex_.size());
  CoarseMesh mesh;
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    if (layer_of_vertex_[v] < num_layers) mesh.vertices.push_back(v);
  }
  if (!output_index.empty()) {
    std::sort(
        mesh.vertices.begin(), mesh.vertices.end(),
        [&](std::uint32_t a, std::uint32_t b) { return output_index[a] < output_index[b]; });
  }
  Vector<std::uint32_t> place(num_vertices);
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) place[mesh.vertices[i]] = i;
  for (const LayeredTriangle& t : triangles_) {
    if (!is_in(t, num_layers)) continue;
    mesh.triangles.push_back(
        {place[t.vertices[0]], place[t.vertices[1]], place[t.vertices[2]]});
  }
  return mesh;
}

MeshSize CoarseMeshes::size(std::uint32_t num_layers) const {
  assert(num_layers > 0);
  num_layers = std::min(num_layers, num_layers_);
  const auto num_vertices =
      std::count_if(layer_of_vertex_.begin(), layer_of_vertex_.end(),
                    [&](std::uint8_t layer) { return layer < num_layers; });
  const auto num_triangles =
      std::count_if(triangles_.begin(), triangles_.end(),
                    [&](const LayeredTriangle& t) { return is_in(t, num_layers); });
  return {static_cast<std::uint32_t>(num_vertices), static_cast<std::uint32_t>(num_triangles)};
}

}  // namespace rlpc
