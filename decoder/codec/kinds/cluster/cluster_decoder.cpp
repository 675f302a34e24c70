#include "decoder/codec/kinds/cluster/cluster_decoder.h"

#include <cstddef>

#include "common/codec/kinds/cluster/recon/cluster_recon.h"
#include "decoder/codec/kinds/cluster/parse/parse_cluster_gof.h"
#include "decoder/codec/recon/recon_of_kind.h"

namespace rlpc {

std::unique_ptr<GofParser> ClusterDecoder::make_parser(const StreamContext& context,
                                                       const MemoryLimit& memory,
                                                       const SliceCut&) {
  return std::make_unique<ClusterGofParser>(context.header, context.topology, memory);
}

std::unique_ptr<GofRecon> ClusterDecoder::make_recon(const ClusterGof& gof,
                                                     const StreamContext& context, RigRecons&) {
  return recon_of_kind(ClusterRecon(context.header, context.topology, gof));
}

// Residuals are dropped after reconstruction.
std::uint64_t ClusterDecoder::memory_of_gof(const ClusterGof& gof,
                                            const SequenceHeader& header) {
  constexpr std::uint64_t kBytesPerValue = 8;  // two limbs
  constexpr std::uint64_t kBytesPerComponent = 400;
  constexpr std::uint64_t kBytesPerSeedValue = 24;
  constexpr std::uint64_t kBytesPerVertex = 16;
  std::uint64_t bytes = header.num_vertices * kBytesPerVertex +
                        gof.seed_tracks.size() * gof.num_frames * kBytesPerSeedValue;
  for (const Cluster& cluster : gof.clusters) {
    for (const Component& c : cluster.components) {
      // The vertices of a cluster take whole tiles.
      const std::uint64_t spatial = c.spatial_residual.size() + 3 * std::uint64_t{kTileValues};
      bytes += kBytesPerComponent + kBytesPerValue * (c.temporal_residual.size() + spatial);
    }
  }
  return bytes;
}

void ClusterDecoder::add_figures(const ClusterGof& gof, GofSummary& summary) {
  std::size_t num_components = 0;
  for (const Cluster& cluster : gof.clusters) num_components += cluster.components.size();
  summary.figures = {{"num_clusters", "cluster", "clusters", count_of(gof.clusters)},
                     {"num_components", "component", "components",
                      static_cast<std::uint32_t>(num_components)}};
}

void ClusterDecoder::add_groups(const ClusterGof& gof, const StreamContext&,
                                VertexGroups& groups) {
  groups.kind = GroupKind::kClusters;
  groups.num_groups = static_cast<std::uint32_t>(gof.clusters.size());
  groups.group_of_vertex.assign(gof.cluster_of_vertex.begin(), gof.cluster_of_vertex.end());
  for (std::size_t i = gof.clusters.size(); i-- > 0;) {  // the first cluster last
    if (!gof.clusters[i].lcf_flag) continue;
    const auto& seed = gof.clusters[i].seed_vertex;
    for (const std::uint32_t v : seed)
      groups.group_of_vertex[v] = static_cast<std::uint32_t>(i);
    groups.seeds.push_back(seed);
  }
  std::reverse(groups.seeds.begin(), groups.seeds.end());
}

}  // namespace rlpc
