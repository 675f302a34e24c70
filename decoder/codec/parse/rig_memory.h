// Estimates the memory of shared rigs, which are alive while GOFs of any kind are decoded, and
// of the parts that skinned GOFs have in common with them. Bounds as in memory_estimate.h.
#pragma once

#include <cstdint>

#include "common/codec/components/component_limits.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

// Parts of a skinned GOF or shared rig, parsed and reconstructed.
//
// Memory of spatial factors: per value its residual and its magnitude, the value, and two limbs
// for the sums, in whole tiles.
constexpr std::uint64_t memory_of_spatial(std::uint64_t num_vertices,
                                          std::uint64_t num_factors) {
  constexpr std::uint64_t kBytesPerValue = 18;
  const std::uint64_t tiles = (num_vertices + kTileValues - 1) / kTileValues;
  return kBytesPerValue * tiles * kTileValues * num_factors;
}
// Memory of tracks: per value of a bone, its residual and a sixth of the pose; per value of a
// trajectory, its residual, the value, and limbs, which may exist twice.
constexpr std::uint64_t memory_of_tracks(std::uint64_t num_values) {
  constexpr std::uint64_t kBytesPerValue = 26;
  return kBytesPerValue * num_values;
}
constexpr std::uint64_t memory_of_trajectories(std::uint64_t count) {
  constexpr std::uint64_t kBytesPerTrajectory = 1000;
  return kBytesPerTrajectory * count;
}
// Memory of vertices: influences, and their copy while absent ones are added; weight, place,
// position and run of each influence; rest positions; ring weights and adaptive weights;
// counterparts, and the hinges that they are chosen from.
constexpr std::uint64_t memory_of_vertices(std::uint64_t num_vertices, bool has_rest_order) {
  constexpr std::uint64_t kBytesPerVertex = 600;
  constexpr std::uint64_t kBytesPerCounterpart = 64;
  return num_vertices * (kBytesPerVertex + (has_rest_order ? kBytesPerCounterpart : 0));
}
// Memory of the final adaptive weights of a shared rig, in a skinned GOF that uses it and has
// local component groups.
constexpr std::uint64_t memory_of_adaptive_weights(std::uint64_t num_vertices) {
  constexpr std::uint64_t kBytesPerVertex = 130;
  return num_vertices * kBytesPerVertex;
}

// Memory of a shared rig with its reconstruction.
inline std::uint64_t memory_of_rig(const SharedRig& rig) {
  const std::uint64_t num_vertices = rig.influences.size();
  return memory_of_vertices(num_vertices, rig.rest.order_flag) +
         memory_of_spatial(num_vertices, kRestFactors + rig.trajectories.size()) +
         memory_of_trajectories(rig.trajectories.size());
}
inline std::uint64_t memory_of_rigs(const RigSlots& rigs) {
  std::uint64_t sum = 0;
  for (const auto& rig : rigs.slots) {
    if (rig) sum += memory_of_rig(*rig);
  }
  return sum;
}

}  // namespace rlpc
