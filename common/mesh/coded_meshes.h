// 8.10 Prediction along the mesh, for each prediction_idc.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/mesh/coded_mesh.h"
#include "common/mesh/topology.h"
#include "common/mesh/vertex_layers.h"

namespace rlpc {

class CodedMeshes {
 public:
  // triangles: in decoded order, read during the call. The topology must outlive it.
  CodedMeshes(const Topology& topology, std::span<const Triangle> triangles)
      : layers_(make_layers(static_cast<std::uint32_t>(topology.earlier_neighbours.size()),
                            triangles)),
        meshes_{CodedMesh(Prediction::kNone, topology, layers_),
                CodedMesh(Prediction::kParallelogram, topology, layers_),
                CodedMesh(Prediction::kParallelograms, topology, layers_),
                CodedMesh(Prediction::kLayers, topology, layers_)} {}
  CodedMeshes(const CodedMeshes&) = delete;
  CodedMeshes& operator=(const CodedMeshes&) = delete;

  const CodedMesh& operator[](Prediction prediction) const {
    return meshes_[static_cast<std::size_t>(prediction)];
  }

 private:
  VertexLayers layers_;
  std::array<CodedMesh, 4> meshes_;
};

}  // namespace rlpc
