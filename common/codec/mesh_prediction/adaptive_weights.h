// 8.15 Adaptive weights: weights of prediction that adapt to the values of a vertex, from one
// spatial factor to the next.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/kernels/kernels.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh_prediction/geometry_weights.h"
#include "common/memory/owned.h"

namespace rlpc {

// The weights of all vertices. start() begins a pass over the mesh: each vertex, in the order
// of the mesh or, within a layer above the base, in any order and on any thread, has its values
// predicted by a VertexAdaptation.
class AdaptiveWeights {
 public:
  // settings.num_adaptive_factors is at least 1; rest: as of GeometryWeights. Mesh and rest are
  // kept by reference.
  AdaptiveWeights(const OrderedMesh& mesh, const GeometryWeights& weights,
                  const WeightSettings& settings,
                  const std::array<std::span<const std::int32_t>, 3>& rest);

  // A pass over `count` trajectories, `first` being the number of those before; none of them,
  // or whole component groups. group_end: ends of the groups of the pass, in trajectories from
  // its first; kept by reference.
  void start(std::size_t first, std::size_t count, std::span<const std::size_t> group_end = {});

 private:
  friend class VertexAdaptation;

  const OrderedMesh& mesh_;
  std::array<std::span<const std::int32_t>, 3> rest_;
  bool adapt_to_rest_;
  std::size_t num_adaptive_factors_;
  bool is_first_ = true;
  std::size_t count_ = 0;           // trajectories of the pass
  std::size_t adaptive_count_ = 0;  // of these, adaptive ones
  std::span<const std::size_t> group_end_;
  Vector<std::uint32_t> first_;   // [num_vertices + 1]
  Vector<std::int32_t> weights_;  // AdaptiveWeights
};

// Predicts the values of one vertex after the other, factor by factor. One per thread.
class VertexAdaptation {
 public:
  explicit VertexAdaptation(AdaptiveWeights& weights);

  // values [num_vertices][count], read during the call. False: the weights of this vertex do
  // not adapt; its values are predicted as of 8.11.
  bool start(std::uint32_t v, std::span<const std::int32_t> values);
  // 8.15.2, for the next factor of the pass.
  std::int64_t predict();
  // Adapts, while factors are adaptive, to the decoded value of the factor.
  void add(std::int64_t prediction, std::int32_t value);
  // After the last factor: keeps the weights.
  void finish();

 private:
  void gather(std::span<const std::int32_t> values);
  void adapt_to_rest();

  AdaptiveWeights& weights_;
  Kernels kernels_;
  WeightFilter filter_;
  std::uint32_t vertex_ = 0;
  std::size_t ring_size_ = 0;
  std::size_t next_ = 0;
  Vector<std::uint32_t> neighbours_;
  Vector<std::int32_t> mean_;     // [count]: of the ring
  Vector<std::int32_t> offsets_;  // [count][stride]
};

}  // namespace rlpc
