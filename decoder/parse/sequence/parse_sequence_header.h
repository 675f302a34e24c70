// 6.3 Sequence header, parsing side.
#pragma once

#include "common/bitstream/bit_reader.h"
#include "common/result.h"
#include "common/syntax/sequence_header.h"

namespace rlpc {

// `r` covers exactly the payload of the unit.
Result<SequenceHeader> parse_sequence_header(BitReader& r, std::uint32_t version_minor);

}  // namespace rlpc
