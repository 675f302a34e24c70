// 6.5.3: cluster maps, parsing side.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/kinds/cluster/cluster_map.h"
#include "common/codec/mesh/topology.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {

// 6.5.3 cluster_map( ): the cluster of each vertex that is not a seed vertex. Errors are left
// in the section.
void parse_cluster_map(SectionReader& section, const Topology& topology,
                       ClusterMapModels& models, std::size_t num_clusters,
                       std::span<std::uint16_t> cluster_of_vertex);

}  // namespace rlpc
