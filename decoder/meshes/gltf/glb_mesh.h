// What is the same in all frames of a glTF mesh: its vertices and triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "decoder/meshes/gltf/glb_buffers.h"

namespace rlpc {

// A mesh in glTF has one list of vertices for all attributes. Where an attribute differs
// between the triangles at a vertex of the stream, that vertex is there several times.
struct GlbMesh {
  struct Part {                             // a primitive
    std::vector<Triangle> triangles;        // of output vertices; none: the vertices as points
    std::optional<std::uint32_t> material;  // none: the default one of glTF
  };

  std::vector<std::uint32_t> vertex;  // [output vertex]: its vertex in the stream
  std::vector<Part> parts;
};

// Each vertex once, all triangles in one part.
GlbMesh plain_mesh(std::uint32_t num_vertices, std::vector<Triangle> triangles);

// Values of the vertices of the stream, `width` each, for the output vertices.
template <class T>
std::vector<T> of_output_vertices(const GlbMesh& mesh, std::span<const T> values,
                                  std::size_t width) {
  std::vector<T> expanded;
  expanded.reserve(mesh.vertex.size() * width);
  for (const std::uint32_t v : mesh.vertex) {
    const auto of_vertex = values.subspan(v * width, width);
    expanded.insert(expanded.end(), of_vertex.begin(), of_vertex.end());
  }
  return expanded;
}

// The primitives of the mesh. attributes: accessors by name; targets: of morph targets, the
// same.
GltfJson primitives_of(const GlbMesh& mesh, const GltfJson& attributes, const GltfJson& targets,
                       GlbBuffers& buffers);

}  // namespace rlpc
