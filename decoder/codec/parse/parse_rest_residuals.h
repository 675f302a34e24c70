// 6.12.4: positions in the rest order, parsing side.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/mesh/rest_order.h"
#include "common/codec/rest/rest_shape.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {

// 6.11 rest_order( exact )
RestSettings parse_rest_settings(BitReader& r, bool exact);

// Parses rest_residuals( v ) of all vertices, in their order. residuals: [num_vertices][3];
// choices: counterparts [num_vertices], or empty if there are none. Errors are left in the
// section.
void parse_rest_residuals(SectionReader& section, const RestOrder& order,
                          std::span<std::int32_t> residuals, std::span<Counterpart> choices);

}  // namespace rlpc
