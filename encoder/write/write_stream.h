// 6.3, 6.6 and 6.10, writing side. Together with common/syntax/write_units.h, these are all
// units except GOFs, slices and connectivity.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/syntax/sequence_header.h"
#include "common/syntax/write_units.h"

namespace rlpc {

// Each returns the payload of a unit.
Bytes write_sequence_header(const SequenceHeader& header);
Bytes write_vertex_order(std::span<const std::uint32_t> output_vertex);
Bytes write_metadata(std::string_view json);

}  // namespace rlpc
