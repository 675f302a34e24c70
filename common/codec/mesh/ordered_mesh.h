// 8.10 Prediction along the mesh: the coding order of the vertices of a skinned GOF, and the
// vertices from which each is predicted.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/mesh/rest_order.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/mesh/vertex_layers.h"
#include "common/memory/owned.h"

namespace rlpc {

// 7.11: prediction_idc
enum class Prediction : std::uint8_t { kNone, kParallelogram, kParallelograms, kLayers };

class OrderedMesh {
 public:
  // References must outlive it. layers: ignored unless prediction is kLayers; rest_order: null
  // below the High profile.
  OrderedMesh(Prediction prediction, const Topology& topology, const VertexLayers& layers,
              const RestOrder* rest_order = nullptr);

  Prediction prediction() const { return prediction_; }
  std::uint32_t num_vertices() const { return static_cast<std::uint32_t>(index_.size()); }
  // CodedOrder
  std::span<const std::uint32_t> order() const;
  // CodedRing and CodedOuterRing of v: vertices that precede v in the order.
  std::span<const std::uint32_t> ring(std::uint32_t v) const;
  std::span<const std::uint32_t> outer_ring(std::uint32_t v) const;
  std::span<const Parallelogram> parallelograms(std::uint32_t v) const {
    return topology_.parallelograms[v];
  }

  const Topology& topology() const { return topology_; }
  // 8.18: returns the rest order (High profile only).
  const RestOrder& rest_order() const { return *rest_order_; }

  std::uint32_t num_layers() const;
  std::uint32_t layer_of(std::uint32_t v) const;
  // 8.10.1 Vertices of a layer group: returns those of layers first to end - 1, in the order.
  std::span<const std::uint32_t> vertices_of_layers(std::uint32_t first,
                                                    std::uint32_t end) const;

 private:
  Prediction prediction_;
  const Topology& topology_;
  const VertexLayers& layers_;
  const RestOrder* rest_order_;
  Vector<std::uint32_t> index_;        // 0, 1, 2, ...
  Vector<std::uint32_t> layer_first_;  // [num_layers + 1], index in the order
};

}  // namespace rlpc
