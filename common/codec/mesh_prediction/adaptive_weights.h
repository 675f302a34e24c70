// 8.15 Adaptive weights: prediction weights that adapt to the values of a vertex, from spatial
// factor to spatial factor.
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

// Weights of all vertices. start() begins a pass over the mesh, in which a VertexAdaptation
// predicts the values of each vertex, in the order of the mesh or, within a layer above the
// base, in any order and on any thread.
class AdaptiveWeights {
 public:
  // settings.num_adaptive_factors: at least 1; rest: see GeometryWeights. Mesh and rest must
  // outlive it.
  AdaptiveWeights(const OrderedMesh& mesh, const GeometryWeights& weights,
                  const WeightSettings& settings,
                  const std::array<std::span<const std::int32_t>, 3>& rest);

  // Starts a pass over `count` trajectories, none or whole component groups, after `first`
  // trajectories of earlier passes. group_end: ends of the groups, in trajectories of the pass;
  // must outlive the pass.
  void start(std::size_t first, std::size_t count, std::span<const std::size_t> group_end = {});

 private:
  friend class VertexAdaptation;

  const OrderedMesh& mesh_;
  std::array<std::span<const std::int32_t>, 3> rest_;
  bool adapt_to_rest_;
  std::size_t num_adaptive_factors_;
  bool is_first_ = true;
  std::size_t count_ = 0;           // trajectories of the pass
  std::size_t adaptive_count_ = 0;  // adaptive trajectories of the pass
  std::span<const std::size_t> group_end_;
  Vector<std::uint32_t> first_;   // [num_vertices + 1]
  Vector<std::int32_t> weights_;  // AdaptiveWeights
};

// Predicts the values of vertex after vertex, factor by factor. One object per thread.
class VertexAdaptation {
 public:
  explicit VertexAdaptation(AdaptiveWeights& weights);

  // Starts a vertex. values: [num_vertices][count], read during the call. Returns false if the
  // weights of this vertex do not adapt; its values are then predicted as in 8.11.
  bool start(std::uint32_t v, std::span<const std::int32_t> values);
  // 8.15.2: predicts the value of the next factor of the pass.
  std::int64_t predict();
  // Adapts to the decoded value of the factor, if the factor is adaptive.
  void add(std::int64_t prediction, std::int32_t value);
  // Keeps the weights, after the last factor.
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
  Vector<std::int32_t> mean_;     // [count] mean of the ring
  Vector<std::int32_t> offsets_;  // [count][stride]
};

}  // namespace rlpc
