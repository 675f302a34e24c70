// 6.9: finds the GOF index of a stream from its end.
#pragma once

#include <cstdint>
#include <vector>

#include "decoder/codec/parse/sequence/parse_gof_index.h"
#include "decoder/codec/units/unit_reader.h"

namespace rlpc {

// Returns the index before the end of the sequence; empty if there is none. Its offsets are
// checked when units are parsed.
//
// first_unit: lower bound of the offset of the end of the sequence, bytes.
Result<GofIndex> find_gof_index(UnitReader& units, std::uint64_t first_unit,
                                const SequenceHeader& header);

}  // namespace rlpc
