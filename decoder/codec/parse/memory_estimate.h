// Estimates the memory that decoding takes from the sizes that a stream declares, before any is
// allocated. The constants are upper bounds of what this decoder allocates, including growing
// vectors; conformance/roundtrip/memory_limit_test.cpp compares.
#pragma once

#include <cstdint>

#include "common/codec/components/component_limits.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// Memory of a stream without GOFs: connectivity, topology, layers (Main and High profile), the
// order of rest positions (High profile), and frames_held frames.
inline std::uint64_t memory_of_stream(const SequenceHeader& header, std::uint32_t frames_held) {
  const std::uint64_t of_layers = header.has_skinned_gofs() ? 300 : 0;
  const std::uint64_t of_rest_order = header.profile_idc >= kProfileHigh ? 200 : 0;
  const std::uint64_t of_vertex =
      100 + of_layers + of_rest_order + std::uint64_t{12} * frames_held;
  return header.num_vertices * of_vertex + std::uint64_t{header.num_triangles} * 120;
}

// Additional memory of a coarse mesh (8.9.8): layers and the triangles of all coarse meshes
// while it is made, then the mesh itself.
inline std::uint64_t memory_of_coarse_mesh(const SequenceHeader& header) {
  constexpr std::uint64_t kBytesPerVertex = 300;
  constexpr std::uint64_t kBytesPerTriangle = 260;
  return header.num_vertices * kBytesPerVertex + header.num_triangles * kBytesPerTriangle;
}

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

// Memory of an inter GOF: frames without their residuals, and their order; per vertex the
// position in several frames, neighbours and weights; with learned weights, errors and a filter
// per temporal layer; models of layer groups per depth.
inline std::uint64_t memory_of_frames(std::uint64_t num_vertices, std::uint64_t num_frames,
                                      const InterSettings& settings) {
  constexpr std::uint64_t kBytesPerFrame = 160;
  constexpr std::uint64_t kBytesPerVertex = 400;
  constexpr std::uint64_t kBytesOfOrder = 100;  // first frame: residuals, counterparts
  constexpr std::uint64_t kBytesOfFilter = 2600;
  constexpr std::uint64_t kBytesPerGroup = 6000;
  constexpr std::uint64_t kBytesPerState = 2;  // per state and vertex
  constexpr std::uint64_t kBytesOfKept = 24;   // a position in decoded and in output order
  const FramePattern& pattern = settings.pattern;
  const std::uint64_t depths = pattern.num_depths();
  const std::uint64_t kept =
      (pattern.kind == FramePattern::kExplicit ? pattern.period() : depths) +
      std::min<std::uint64_t>(settings.max_earlier_distance, num_frames);
  const std::uint64_t states = depths + 1;      // number of context states
  constexpr std::uint64_t kBytesOfPatch = 160;  // its contexts, and its last motion
  const std::uint64_t filters = settings.learning_flag ? pattern.temporal_layers : 0;
  return num_frames * kBytesPerFrame +
         states * settings.layer_group_size.size() * kBytesPerGroup +
         states * settings.num_patches * kBytesOfPatch +
         num_vertices *
             (kBytesPerVertex + (settings.rest.order_flag ? kBytesOfOrder : 0) +
              filters * kBytesOfFilter + states * kBytesPerState + kept * kBytesOfKept);
}
// Memory of the residuals of a frame, of which some are large, and the motion of its patches.
constexpr std::uint64_t memory_of_frame(std::uint64_t num_vertices, std::uint64_t num_large,
                                        std::uint64_t num_patches) {
  return 5 * num_vertices + 32 * num_large + sizeof(PatchMotion) * num_patches;
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
  for (const auto& rig : rigs.of_idx) {
    if (rig) sum += memory_of_rig(*rig);
  }
  return sum;
}

}  // namespace rlpc
