// 8.10.3 Prediction of a value: predicts spatial values of a vertex from preceding vertices.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/kernels/kernels.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh_prediction/geometry_weights.h"

namespace rlpc {

class ValuePrediction {
 public:
  // weights: null for rest positions and for GOFs without layers.
  ValuePrediction(const OrderedMesh& mesh, bool is_rest, const GeometryWeights* weights)
      : mesh_(mesh), is_rest_(is_rest), weights_(weights), loops_(kernels().back()) {}

  // values: [num_vertices][n]; prediction: [n]; n: number of factors.
  void predict(std::uint32_t v, std::span<const std::int32_t> values,
               std::span<std::int64_t> prediction) const;

 private:
  void by_parallelograms(std::span<const Parallelogram> list,
                         std::span<const std::int32_t> values,
                         std::span<std::int64_t> prediction) const;

  const OrderedMesh& mesh_;
  bool is_rest_;
  const GeometryWeights* weights_;
  Kernels loops_;
};

}  // namespace rlpc
