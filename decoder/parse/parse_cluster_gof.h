// 6.5 Group of frames, parsing side.
#pragma once

#include <cstdint>

#include "common/bitstream/bit_reader.h"
#include "common/cluster_gof/cluster_gof.h"
#include "common/mesh/topology.h"
#include "common/result.h"
#include "common/syntax/sequence_header.h"

namespace rlpc {

// What stands in a GOF unit before its clusters or bones.
struct GofStart {
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 1;
  bool bones_flag = false;
};
// 6.5 gof( ), up to its clusters or bones. first_frame, less than num_frames of the header, is
// what the stream has to say. The error is left in `r`.
GofStart parse_gof_start(BitReader& r, const SequenceHeader& header, std::uint32_t first_frame);

// 6.5 clusters_of_gof( ): the rest of the payload, to which `r` ends. Every size is checked
// against the level, and what its factors need against max_memory_bytes, before memory is taken
// for it.
Result<ClusterGof> parse_clusters(BitReader& r, const SequenceHeader& header,
                                  const Topology& topology, const GofStart& start,
                                  std::uint64_t max_memory_bytes);

}  // namespace rlpc
