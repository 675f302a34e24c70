// 6.9: the GOF index of a stream, found from its end.
#pragma once

#include <cstdint>
#include <vector>

#include "decoder/parse/sequence/parse_gof_index.h"
#include "decoder/stream/unit_reader.h"

namespace rlpc {

// The GOFs listed by the index before the end of the sequence; empty if there is none. Whether
// they are there is checked when they are parsed (parse_gof_header).
//
// first_unit  lower bound of the offset of the end of the sequence, bytes
//   num_frames  of the sequence
Result<std::vector<GofLocation>> find_gof_index(UnitReader& units, std::uint64_t first_unit,
                                                std::uint32_t num_frames);

}  // namespace rlpc
