// Warnings about a GOF or skinned model: what is legal, but surely not intended; and the level
// that it needs.
#pragma once

#include <cstdint>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/skinned/model_slots.h"
#include "common/codec/syntax/stream_context.h"
#include "conformance/rlpcval/validator_findings.h"

namespace rlpc {

// Whether a trajectory is zero in all frames of a GOF.
bool is_still(const Trajectory& trajectory);

// models: those alive. bit_pos: of the payload of the GOF unit. needed: raised to what the GOF
// needs.
void warn_of_gof(const AccessUnit& access_unit, const StreamContext& context,
                 const ModelSlots& models, std::uint64_t bit_pos, FindingList& findings,
                 Level& needed);
// models: those alive, with this one.
void warn_of_model(const SkinnedModel& model, const StreamContext& context,
                   const ModelSlots& models, std::uint64_t bit_pos, FindingList& findings,
                   Level& needed);

}  // namespace rlpc
