// Warnings about a GOF: what is legal, but surely not intended; and the level that it needs.
#pragma once

#include <cstdint>

#include "common/syntax/access_unit.h"
#include "common/syntax/stream_context.h"
#include "conformance/rlpcval/validator_findings.h"

namespace rlpc {

// bit_pos: of the payload of the GOF unit. needed: raised to what the GOF needs.
void warn_of_gof(const AccessUnit& access_unit, const StreamContext& context,
                 std::uint64_t bit_pos, FindingList& findings, Level& needed);

}  // namespace rlpc
