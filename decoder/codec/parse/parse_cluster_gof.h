// 6.5 clusters_of_gof( ), parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/syntax/gof_header.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/result.h"
#include "decoder/codec/parse/memory_limit.h"

namespace rlpc {

// 6.5 clusters_of_gof( ): the rest of the payload, where `r` ends. Checks every size against
// the level, and the memory of the factors against the limit, before allocating.
Result<ClusterGof> parse_clusters(BitReader& r, const SequenceHeader& header,
                                  const Topology& topology, const GofHeader& gof_header,
                                  const MemoryLimit& memory);

}  // namespace rlpc
