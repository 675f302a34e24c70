#include "decoder/meshes/gltf/glb_mesh.h"

#include <numeric>
#include <utility>

namespace rlpc {
namespace {

constexpr int kPoints = 0;
constexpr int kTriangles = 4;

}  // namespace

GlbMesh plain_mesh(std::uint32_t num_vertices, std::vector<Triangle> triangles) {
  GlbMesh mesh;
  mesh.vertex.resize(num_vertices);
  std::iota(mesh.vertex.begin(), mesh.vertex.end(), 0U);
  mesh.parts.push_back({std::move(triangles), std::nullopt});
  return mesh;
}

GltfJson primitives_of(const GlbMesh& mesh, const GltfJson& attributes, const GltfJson& targets,
                       GlbBuffers& buffers) {
  GltfJson primitives = GltfJson::array();
  for (const GlbMesh::Part& part : mesh.parts) {
    GltfJson primitive = {{"attributes", attributes},
                          {"mode", part.triangles.empty() ? kPoints : kTriangles}};
    if (!part.triangles.empty()) {
      primitive["indices"] =
          buffers.add_indices(part.triangles, static_cast<std::uint32_t>(mesh.vertex.size()));
    }
    if (!targets.empty()) primitive["targets"] = targets;
    if (part.material) primitive["material"] = *part.material;
    primitives.push_back(std::move(primitive));
  }
  return primitives;
}

}  // namespace rlpc
