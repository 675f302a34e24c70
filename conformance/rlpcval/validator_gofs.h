// Warnings about a GOF or shared rig (legal, but surely not intended), and the level that it
// needs.
#pragma once

#include <cstdint>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/syntax/stream_context.h"
#include "conformance/rlpcval/validator_findings.h"

namespace rlpc {

// Whether a trajectory is zero in all frames of a GOF.
bool is_still(const Trajectory& trajectory);

// Warns of a GOF. rigs: those alive. bit_pos: start of the payload of the GOF unit. needed:
// raised to the level that the GOF needs.
void warn_of_gof(const AccessUnit& access_unit, const StreamContext& context,
                 const RigSlots& rigs, std::uint64_t bit_pos, FindingList& findings,
                 Level& needed);
// Warns of a shared rig. rigs: those alive, this one included.
void warn_of_rig(const SharedRig& rig, const StreamContext& context, const RigSlots& rigs,
                 std::uint64_t bit_pos, FindingList& findings, Level& needed);

}  // namespace rlpc
