// Vertices and triangles of a glTF mesh, which are the same in all frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "decoder/meshes/gltf/glb_buffers.h"

namespace rlpc {

// Mesh with one list of vertices for all attributes, as glTF requires: a vertex of the stream
// at which an attribute differs between triangles is repeated.
struct GlbMesh {
  struct Part {                             // a primitive
    std::vector<Triangle> triangles;        // indices of output vertices; empty: points
    std::optional<std::uint32_t> material;  // none: the default material of glTF
  };

  std::vector<std::uint32_t> vertex;  // [output vertex] vertex of the stream
  std::vector<Part> parts;
};

// Returns a mesh with each vertex once and all triangles in one part.
GlbMesh plain_mesh(std::uint32_t num_vertices, std::vector<Triangle> triangles);

// Copies values of the vertices of the stream, `width` each, to the output vertices.
template <class T>
std::vector<T> expanded_values(const GlbMesh& mesh, std::span<const T> values,
                               std::size_t width) {
  std::vector<T> expanded;
  expanded.reserve(mesh.vertex.size() * width);
  for (const std::uint32_t v : mesh.vertex) {
    const auto vertex_values = values.subspan(v * width, width);
    expanded.insert(expanded.end(), vertex_values.begin(), vertex_values.end());
  }
  return expanded;
}

// Returns the primitives of the mesh. attributes: accessors by name; targets: accessors by name
// of each morph target.
GltfJson primitives_of(const GlbMesh& mesh, const GltfJson& attributes, const GltfJson& targets,
                       GlbBuffers& buffers);

}  // namespace rlpc
