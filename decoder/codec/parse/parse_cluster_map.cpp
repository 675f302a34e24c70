#include "decoder/codec/parse/parse_cluster_map.h"

#include <cstddef>

#include "common/codec/bits/int_math.h"

namespace rlpc {
namespace {

std::uint16_t parse_cluster(SectionReader& section, ClusterMapModels& models,
                            std::size_t num_clusters, const ClusterPrediction& prediction) {
  if (section.bin(models.cluster_predicted_flag[prediction.context],
                  "cluster_predicted_flag")) {
    return prediction.cluster;
  }
  const std::uint32_t index = section.tree(models.cluster_idx, "cluster_idx");
  if (index < num_clusters) return static_cast<std::uint16_t>(index);
  section.fail("R-GOF-08", "cluster_idx");
  return 0;
}

}  // namespace

void parse_cluster_map(SectionReader& section, const Topology& topology,
                       ClusterMapModels& models, std::size_t num_clusters,
                       std::span<std::uint16_t> cluster_of_vertex) {
  models.cluster_idx.resize(std::size_t{1} << ceil_log2(num_clusters));
  std::uint16_t previous = 0;
  for (std::size_t v = 0; v < cluster_of_vertex.size() && !section.failed(); ++v) {
    if (cluster_of_vertex[v] == kSeedCluster) continue;
    if (num_clusters > 1) {
      previous = parse_cluster(
          section, models, num_clusters,
          predict_cluster(topology.earlier_neighbours[v], cluster_of_vertex, previous));
    }
    cluster_of_vertex[v] = previous;
  }
  section.check_overrun("cluster_idx");
}

}  // namespace rlpc
