#include "encoder/codec/write/write_cluster_map.h"

#include <cstddef>

#include "common/codec/bits/int_math.h"

namespace rlpc {
namespace {

void write_cluster(SectionWriter& section, ClusterMapModels& models, std::size_t num_clusters,
                   const ClusterPrediction& prediction, std::uint16_t cluster) {
  const bool predicted = prediction.cluster == cluster;
  section.bin(models.cluster_predicted_flag[prediction.context], predicted);
  if (predicted) return;
  std::uint32_t node = 1;
  for (int bit = ceil_log2(num_clusters) - 1; bit >= 0; --bit) {
    const bool one = ((cluster >> bit) & 1) != 0;
    section.bin(models.cluster_idx[node], one);
    node = 2 * node + (one ? 1U : 0U);
  }
}

}  // namespace

void write_cluster_map(SectionWriter& section, const Topology& topology,
                       ClusterMapModels& models, std::size_t num_clusters,
                       std::span<const std::uint16_t> cluster_of_vertex) {
  models.cluster_idx.resize(std::size_t{1} << ceil_log2(num_clusters));
  if (num_clusters == 1) return;
  std::uint16_t previous = 0;
  for (std::size_t v = 0; v < cluster_of_vertex.size(); ++v) {
    if (cluster_of_vertex[v] == kSeedCluster) continue;
    const auto neighbours = topology.earlier_neighbours[v];
    write_cluster(section, models, num_clusters,
                  predict_cluster(neighbours, cluster_of_vertex, previous),
                  cluster_of_vertex[v]);
    previous = cluster_of_vertex[v];
  }
}

}  // namespace rlpc
