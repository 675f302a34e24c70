// 8.11 Geometry weights: the weights for the prediction of a vertex from its rings, derived
// from their positions in the rest shape.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh/weight_settings.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr int kWeightFractionBits = 14;

class GeometryWeights {
 public:
  // rest: x, y and z of the rest positions, [num_vertices] each, within 29 bits. The mesh must
  // have layers. outer: vertices that replace the outer rings; null: none.
  GeometryWeights(const OrderedMesh& mesh, const WeightSettings& settings,
                  const std::array<std::span<const std::int32_t>, 3>& rest,
                  const VertexLists* outer = nullptr);

  // Returns the weights of the vertices in the ring of v, then of those outside it.
  std::span<const std::int32_t> operator[](std::uint32_t v) const {
    return std::span(weights_).subspan(first_[v], first_[v + 1] - first_[v]);
  }
  std::size_t size() const { return weights_.size(); }  // number of weights of all vertices

 private:
  Vector<std::uint32_t> first_;  // [num_vertices + 1]
  Vector<std::int32_t> weights_;
};

}  // namespace rlpc
