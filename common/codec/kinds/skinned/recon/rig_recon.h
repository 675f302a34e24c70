// 8.14 and 8.16.1: the reconstructed rig of a skinned GOF or shared rig: all that depends on
// vertices. Made once for all GOFs that use a shared rig, and then read-only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/codec/kernels/component_sum.h"
#include "common/codec/kernels/kernels.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh_prediction/adaptive_weights.h"
#include "common/codec/mesh_prediction/value_prediction.h"
#include "common/memory/owned.h"

namespace rlpc {

// 8.10.2 Spatial values: returns the contribution of a residual of rest positions, or of
// trajectories, at a vertex of a layer.
inline std::int64_t rest_difference(const SharedRig& rig, std::int32_t residual,
                                    int layer_step) {
  return round2(std::int64_t{residual} * layer_step * rig.rest_step, 4);
}
inline std::int64_t factor_difference(std::int32_t residual, int layer_step) {
  return std::int64_t{residual} * layer_step;
}

// 8.10.2 Spatial values: returns those of the factors of a group, [num_vertices][factors];
// absent slices have no residuals. weights: null if no factor is adaptive.
Vector<std::int32_t> recon_values(const OrderedMesh& mesh, const SharedRig& rig,
                                  std::size_t group, int position_bits,
                                  const ValuePrediction& prediction,
                                  AdaptiveWeights* weights = nullptr);

// 8.14.1 AddAbsentInfluences( ): returns the influences of all vertices, [num_vertices],
// predicted where the slice is absent.
Vector<Influences> complete_influences(const OrderedMesh& mesh, const SharedRig& rig);

class RigRecon {
 public:
  // Influences of one bone on the vertices of a tile.
  struct Run {
    std::uint32_t bone;
    BoneArms arms;
    std::span<const std::uint8_t> place;  // index of each vertex in its tile
  };

  // The mesh must outlive it; the rig is read only during the call. has_more_groups: whether
  // local_factors() may be called. Cannot fail.
  RigRecon(const OrderedMesh& mesh, const SharedRig& rig, int position_bits,
           bool has_more_groups);
  // Takes the spatial values of all trajectories, [num_vertices][trajectory], instead of
  // reconstructing them.
  RigRecon(const OrderedMesh& mesh, const SharedRig& rig, int position_bits,
           std::span<const std::int32_t> values);
  RigRecon(const RigRecon&) = delete;
  RigRecon& operator=(const RigRecon&) = delete;

  const OrderedMesh& mesh() const { return mesh_; }
  std::size_t num_vertices() const { return mesh_.num_vertices(); }
  int position_bits() const { return position_bits_; }
  std::size_t num_tiles() const { return first_run_.size() - 1; }
  std::size_t num_runs(std::size_t tile) const {
    return first_run_[tile + 1] - first_run_[tile];
  }
  Run run(std::size_t tile, std::size_t i) const;
  // Returns the spatial factors of the trajectories.
  const std::shared_ptr<const SpatialFactors>& factors() const { return factors_; }
  // Returns the spatial factors of the local component groups of a skinned GOF with a shared
  // rig.
  std::shared_ptr<const SpatialFactors> local_factors(const SkinnedGof& gof) const;
  // Returns the weights with which local component groups begin; null: they do not adapt.
  const AdaptiveWeights* adaptive_weights() const { return adaptive_ ? &*adaptive_ : nullptr; }

 private:
  struct RunRange {
    std::uint32_t bone;
    std::uint32_t first;
    std::uint32_t end;
  };

  Vector<std::int32_t> recon_rest(const SharedRig& rig) const;
  void add_influences(const SharedRig& rig, std::span<const std::int32_t> rest);
  void start_weights(const SharedRig& rig, std::span<const std::int32_t> rest);
  std::shared_ptr<const SpatialFactors> recon_factors(const SharedRig& rig,
                                                      AdaptiveWeights* adaptive) const;

  const OrderedMesh& mesh_;
  int position_bits_;
  Vector<RunRange> runs_;
  Vector<std::size_t> first_run_;  // [tiles + 1]
  // Influences by tile, then by bone.
  std::array<Vector<std::int32_t>, 3> arm_;  // rest position relative to the pivot
  Vector<std::int32_t> weight_;
  Vector<std::uint8_t> place_;
  std::shared_ptr<const SpatialFactors> factors_;
  // Kept for local component groups.
  std::array<Vector<std::int32_t>, 3> rest_;
  std::optional<GeometryWeights> weights_;
  std::optional<AdaptiveWeights> adaptive_;
};

}  // namespace rlpc
