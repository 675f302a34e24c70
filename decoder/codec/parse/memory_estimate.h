// The memory that decoding takes, estimated from the sizes that a stream declares before any is
// allocated. The constants are upper bounds of what this decoder allocates, including vectors
// that grow; conformance/roundtrip/memory_limit_test.cpp compares.
#pragma once

#include <cstdint>

#include "common/codec/components/component_limits.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// Throughout a stream: connectivity, topology, in the Main profile layers, in the High profile
// the order of rest positions, and frames_held frames.
inline std::uint64_t memory_of_stream(const SequenceHeader& header, std::uint32_t frames_held) {
  const std::uint64_t of_layers = header.has_skinned_gofs() ? 300 : 0;
  const std::uint64_t of_rest_order = header.profile_idc >= kProfileHigh ? 200 : 0;
  const std::uint64_t of_vertex =
      100 + of_layers + of_rest_order + std::uint64_t{12} * frames_held;
  return header.num_vertices * of_vertex + std::uint64_t{header.num_triangles} * 120;
}

// Beyond that, for a coarse mesh (8.9.8): layers and the triangles of all coarse meshes while
// it is made, then the mesh itself.
inline std::uint64_t memory_of_coarse_mesh(const SequenceHeader& header) {
  constexpr std::uint64_t kBytesPerVertex = 300;
  constexpr std::uint64_t kBytesPerTriangle = 260;
  return header.num_vertices * kBytesPerVertex + header.num_triangles * kBytesPerTriangle;
}

// The parts of a skinned GOF or shared rig, parsed and reconstructed.
//
// Spatial factors: per value its residual and its magnitude, the value, and two limbs of it for
// the sums, in whole tiles.
constexpr std::uint64_t memory_of_spatial(std::uint64_t num_vertices,
                                          std::uint64_t num_factors) {
  constexpr std::uint64_t kBytesPerValue = 18;
  const std::uint64_t tiles = (num_vertices + kTileValues - 1) / kTileValues;
  return kBytesPerValue * tiles * kTileValues * num_factors;
}
// Tracks: per value of a bone its residual and a sixth of the pose; of a trajectory its
// residual, the value, and limbs of it, which may be there twice.
constexpr std::uint64_t memory_of_tracks(std::uint64_t num_values) {
  constexpr std::uint64_t kBytesPerValue = 26;
  return kBytesPerValue * num_values;
}
constexpr std::uint64_t memory_of_trajectories(std::uint64_t count) {
  constexpr std::uint64_t kBytesPerTrajectory = 1000;
  return kBytesPerTrajectory * count;
}
// Vertices: influences and their copy while absent ones are added; weight, place, position and
// run of each influence; rest positions; weights of the rings, and adaptive ones. Counterparts,
// and the hinges that they are chosen from.
constexpr std::uint64_t memory_of_vertices(std::uint64_t num_vertices, bool has_rest_order) {
  constexpr std::uint64_t kBytesPerVertex = 600;
  constexpr std::uint64_t kBytesPerCounterpart = 64;
  return num_vertices * (kBytesPerVertex + (has_rest_order ? kBytesPerCounterpart : 0));
}
// In a skinned GOF with a shared rig with local component groups: the adaptive weights as the
// shared rig has left them.
constexpr std::uint64_t memory_of_adaptive_weights(std::uint64_t num_vertices) {
  constexpr std::uint64_t kBytesPerVertex = 130;
  return num_vertices * kBytesPerVertex;
}

// An inter GOF: frames without their residuals, and their order; per vertex the position in
// several frames, neighbours and weights; with learned weights, for each temporal layer, errors
// and a filter; models of layer groups, for each depth.
inline std::uint64_t memory_of_frames(std::uint64_t num_vertices, std::uint64_t num_frames,
                                      const InterSettings& settings) {
  constexpr std::uint64_t kBytesPerFrame = 160;
  constexpr std::uint64_t kBytesPerVertex = 400;
  constexpr std::uint64_t kBytesOfOrder = 100;  // of the first frame: residuals, counterparts
  constexpr std::uint64_t kBytesOfFilter = 2600;
  constexpr std::uint64_t kBytesPerGroup = 6000;
  constexpr std::uint64_t kBytesPerState = 2;  // and vertex
  constexpr std::uint64_t kBytesOfKept = 24;   // a position, and as it is output
  const FramePattern& pattern = settings.pattern;
  const std::uint64_t depths = pattern.num_depths();
  const std::uint64_t kept =
      (pattern.kind == FramePattern::kExplicit ? pattern.period() : depths) +
      std::min<std::uint64_t>(settings.max_earlier_distance, num_frames);
  const std::uint64_t states = depths + 1;      // of contexts
  constexpr std::uint64_t kBytesOfPatch = 160;  // its contexts, and its last motion
  const std::uint64_t filters = settings.learning_flag ? pattern.temporal_layers : 0;
  return num_frames * kBytesPerFrame +
         states * settings.layer_group_size.size() * kBytesPerGroup +
         states * settings.num_patches * kBytesOfPatch +
         num_vertices *
             (kBytesPerVertex + (settings.rest.order_flag ? kBytesOfOrder : 0) +
              filters * kBytesOfFilter + states * kBytesPerState + kept * kBytesOfKept);
}
// The residuals of a frame, of which some are large, and the motion of its patches.
constexpr std::uint64_t memory_of_frame(std::uint64_t num_vertices, std::uint64_t num_large,
                                        std::uint64_t num_patches) {
  return 5 * num_vertices + 32 * num_large + sizeof(PatchMotion) * num_patches;
}

// Shared rigs that are kept, with their reconstructions.
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
