// 6.5 Group of frames, writing side.
#pragma once

#include <cstdint>
#include <vector>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// Returns the payload of the unit of a cluster GOF, for either profile. All values must be
// legal, which is asserted: an encoder that emits an illegal value has a bug.
std::vector<std::uint8_t> write_cluster_gof(const ClusterGof& gof, const SequenceHeader& header,
                                            const Topology& topology);

}  // namespace rlpc
