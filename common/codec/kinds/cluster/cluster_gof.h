// Cluster GOF (6.5), passed from the parser to reconstruction, and from the analysis to the
// writer.
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/components/component_limits.h"
#include "common/codec/kinds/cluster/cluster_map.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/syntax/gof_header.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::uint32_t kMaxSeedStep = 1U << 16;

enum class SpatialPredictor : std::uint8_t { kNone = 0, kNeighbours = 1, kParallelogram = 2 };
inline constexpr int kMaxSpatialPredictor = 2;

// Product of a temporal and a spatial factor (clause 8.5): residuals, before prediction is
// undone.
struct Component {
  int scale_idx = 0;
  int spatial_bits = 1;
  int temporal_bits = 1;
  int temporal_predictor = 0;  // order, 0 to kMaxPredictorOrder
  SpatialPredictor spatial_predictor = SpatialPredictor::kNone;
  Vector<std::int32_t> temporal_residual;  // [num_gof_frames]
  Vector<std::int32_t> spatial_residual;   // [3][coded vertices of the cluster]

  bool operator==(const Component&) const = default;
};

struct Cluster {
  bool lcf_flag = false;
  std::array<std::uint32_t, 3> seed_vertex{};  // set with lcf_flag: three distinct vertices
  Vector<Component> components;

  bool operator==(const Cluster&) const = default;
};

// Residuals of the track of one seed vertex, in steps. Tracks are in the order of clause 6.5.2:
// clusters in order, their seeds in order, each vertex once.
struct SeedTrack {
  std::uint32_t vertex = 0;
  std::uint32_t anchor = 0;  // track of seed 0 of the cluster; for seed 0, this track
  Vector<Vec3i> residual;    // [num_gof_frames]

  bool operator==(const SeedTrack&) const = default;
};

struct ClusterGof : GofHeader {
  int fraction_bits = 0;
  std::uint32_t seed_step = 1;
  int seed_predictor = 1;  // order, 0 to kMaxPredictorOrder
  bool seed_coupling_flag = false;
  Vector<Cluster> clusters;
  Vector<SeedTrack> seed_tracks;
  Vector<std::uint16_t> cluster_of_vertex;  // [num_vertices]; seed vertices: kSeedCluster

  bool operator==(const ClusterGof&) const = default;
};

}  // namespace rlpc
