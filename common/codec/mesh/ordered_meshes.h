// 8.10 Prediction along the mesh, for each prediction_idc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh/rest_order.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/mesh/vertex_layers.h"
#include "common/memory/owned.h"

namespace rlpc {

class OrderedMeshes {
 public:
  // triangles: in decoded order, read during the call. The topology must outlive it.
  // has_rest_order: true in the High profile.
  OrderedMeshes(const Topology& topology, std::span<const Triangle> triangles,
                bool has_rest_order = true)
      : layers_(make_layers(static_cast<std::uint32_t>(topology.earlier_neighbours.size()),
                            triangles)) {
    if (has_rest_order) rest_order_.emplace(topology, triangles);
    for (const auto prediction : {Prediction::kNone, Prediction::kParallelogram,
                                  Prediction::kParallelograms, Prediction::kLayers}) {
      meshes_.emplace_back(prediction, topology, layers_,
                           rest_order_ ? &*rest_order_ : nullptr);
    }
  }
  OrderedMeshes(const OrderedMeshes&) = delete;
  OrderedMeshes& operator=(const OrderedMeshes&) = delete;

  const OrderedMesh& operator[](Prediction prediction) const {
    return meshes_[static_cast<std::size_t>(prediction)];
  }

 private:
  VertexLayers layers_;
  std::optional<RestOrder> rest_order_;
  Vector<OrderedMesh> meshes_;
};

}  // namespace rlpc
