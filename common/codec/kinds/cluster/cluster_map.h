// Models and contexts of the map of clusters or patches of a GOF (clause 9.6.2). The parser and
// the writer drive them in the same way.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/bits/bit_model.h"
#include "common/memory/owned.h"

namespace rlpc {

// Cluster index of a seed vertex, which is reconstructed from its track.
inline constexpr std::uint16_t kSeedCluster = 0xFFFF;

struct ClusterMapModels {
  std::array<BitModel, 3> cluster_predicted_flag;
  Vector<BitModel> cluster_idx;  // [node of the binary tree]
};

// 9.6.2 Predicted cluster, from the neighbours already decoded.
struct ClusterPrediction {
  std::uint16_t cluster = 0;
  // Context of cluster_predicted_flag; 0: no neighbour, 1: the neighbours agree, 2: they
  // differ.
  std::size_t context = 0;
};

inline ClusterPrediction predict_cluster(std::span<const std::uint32_t> earlier_neighbours,
                                         std::span<const std::uint16_t> cluster_of_vertex,
                                         std::uint16_t previous) {
  ClusterPrediction prediction{previous, 0};
  for (const std::uint32_t u : earlier_neighbours) {
    const std::uint16_t cluster = cluster_of_vertex[u];
    if (cluster == kSeedCluster) continue;
    if (prediction.context != 0 && cluster != prediction.cluster) prediction.context = 2;
    prediction.context = std::max<std::size_t>(prediction.context, 1);
    prediction.cluster = cluster;
  }
  return prediction;
}

}  // namespace rlpc
