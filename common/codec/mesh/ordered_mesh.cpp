#include "common/codec/mesh/ordered_mesh.h"

#include <algorithm>
#include <numeric>

namespace rlpc {

OrderedMesh::OrderedMesh(Prediction prediction, const Topology& topology,
                         const VertexLayers& layers, const RestOrder* rest_order)
    : prediction_(prediction),
      topology_(topology),
      layers_(layers),
      rest_order_(rest_order),
      index_(topology.earlier_neighbours.size()) {
  std::iota(index_.begin(), index_.end(), 0U);
  layer_first_.assign(num_layers() + 1, 0);
  for (const std::uint32_t v : index_) ++layer_first_[layer_of(v) + 1];
  std::partial_sum(layer_first_.begin(), layer_first_.end(), layer_first_.begin());
}

std::span<const std::uint32_t> OrderedMesh::order() const {
  return prediction_ == Prediction::kLayers ? layers_.layer_order : index_;
}

std::span<const std::uint32_t> OrderedMesh::ring(std::uint32_t v) const {
  if (prediction_ == Prediction::kLayers) return layers_.ring[v];
  const auto neighbours = topology_.earlier_neighbours[v];
  if (!neighbours.empty() || v == 0) {
    return neighbours.last(std::min(neighbours.size(), kMaxRing));
  }
  return std::span(index_).subspan(v - 1, 1);
}

std::span<const std::uint32_t> OrderedMesh::outer_ring(std::uint32_t v) const {
  if (prediction_ == Prediction::kLayers) return layers_.outer_ring[v];
  return {};
}

std::uint32_t OrderedMesh::num_layers() const {
  return prediction_ == Prediction::kLayers ? layers_.num_layers : 1;
}

std::uint32_t OrderedMesh::layer_of(std::uint32_t v) const {
  return prediction_ == Prediction::kLayers ? layers_.layer_of_vertex[v] : 0;
}

std::span<const std::uint32_t> OrderedMesh::vertices_of_layers(std::uint32_t first,
                                                               std::uint32_t end) const {
  return order().subspan(layer_first_[first], layer_first_[end] - layer_first_[first]);
}

}  // namespace rlpc
