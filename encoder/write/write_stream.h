// 6.3, 6.6 and 6.10, writing side: with the units of common/syntax/write_units.h, all around
// the GOFs.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/syntax/sequence_header.h"
#include "common/syntax/write_units.h"

namespace rlpc {

// All are payloads.
Bytes write_sequence_header(const SequenceHeader& header);
Bytes write_vertex_order(std::span<const std::uint32_t> output_vertex);
Bytes write_metadata(std::string_view json);

}  // namespace rlpc
