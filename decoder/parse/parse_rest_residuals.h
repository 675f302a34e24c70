// 6.12.4 Rest residuals of a vertex, parsing side.
#pragma once

#include <cstdint>
#include <span>

#include "common/mesh/rest_order.h"
#include "common/rest/rest_shape.h"
#include "decoder/parse/section_reader.h"

namespace rlpc {

// rest_residuals( v ) of all vertices, in their order: residuals, [num_vertices][3], and
// counterparts, [num_vertices], or empty if there are none. Errors are left in the section.
void parse_rest_residuals(SectionReader& section, const RestOrder& order,
                          std::span<std::int32_t> residuals,
                          std::span<Counterpart> counterparts);

}  // namespace rlpc
