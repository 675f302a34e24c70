// 6.5 Group of frames, parsing side.
#pragma once

#include <cstdint>

#include "common/bit_reader.h"
#include "common/gof.h"
#include "common/result.h"
#include "common/sequence_header.h"
#include "common/topology.h"

namespace rlpc {

// The first two elements of a GOF: checks first_frame, returns the number of frames. The error
// is left in `r`. first_frame < num_frames.
std::uint32_t parse_gof_frames(BitReader& r, const SequenceHeader& header,
                               std::uint32_t first_frame);

// Parses the payload of a GOF unit; `r` covers exactly the payload. Every size is checked
// against the level, and what its factors need against max_memory_bytes, before memory is taken
// for it.
Result<Gof> parse_gof(BitReader& r, const SequenceHeader& header, const Topology& topology,
                      std::uint32_t first_frame, std::uint64_t max_memory_bytes);

}  // namespace rlpc
