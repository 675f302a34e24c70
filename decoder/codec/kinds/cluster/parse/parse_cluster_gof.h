// 6.5 clusters_of_gof( ), parsing side.
#pragma once

#include <cstdint>
#include <utility>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/syntax/gof_header.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/result.h"
#include "decoder/codec/parse/gof_parser.h"
#include "decoder/codec/parse/memory_limit.h"

namespace rlpc {

// 6.5 clusters_of_gof( ), up to its section. Returns the number of clusters. Errors are left in
// `r`.
std::uint32_t parse_clusters_header(BitReader& r, const SequenceHeader& header,
                                    ClusterGof& gof);

// 6.5 clusters_of_gof( ): the rest of the payload, where `r` ends. Checks every size against
// the level, and the memory of the factors against the limit, before allocating.
Result<ClusterGof> parse_clusters(BitReader& r, const SequenceHeader& header,
                                  const Topology& topology, const GofHeader& gof_header,
                                  const MemoryLimit& memory);

class ClusterGofParser final : public GofParser {
 public:
  // The references must outlive it.
  ClusterGofParser(const SequenceHeader& header, const Topology& topology,
                   const MemoryLimit& memory)
      : header_(header), topology_(topology), memory_(memory) {}

  Result<bool> gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) override;
  AnyGof take_gof() override { return std::move(gof_); }

 private:
  const SequenceHeader& header_;
  const Topology& topology_;
  MemoryLimit memory_;
  ClusterGof gof_;
};

}  // namespace rlpc
