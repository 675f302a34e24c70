// 6.5.3: cluster maps, writing side.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/kinds/cluster/cluster_map.h"
#include "common/codec/mesh/topology.h"
#include "encoder/codec/write/section_writer.h"

namespace rlpc {

// 6.5.3 cluster_map( ): the cluster of each vertex that is not a seed vertex.
void write_cluster_map(SectionWriter& section, const Topology& topology,
                       ClusterMapModels& models, std::size_t num_clusters,
                       std::span<const std::uint16_t> cluster_of_vertex);

}  // namespace rlpc
