// Encodes a span with the skinned model of an earlier one: as GOFs of tracks alone.
#pragma once

#include <optional>

#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_frames.h"
#include "encoder/skinned_gof/quantise/kept_model.h"
#include "encoder/skinned_gof/search/skinned_context.h"

namespace rlpc {

// None: it costs at least `most` (Lagrangian cost), or is expected to cost far more. step:
// quantiser step, grid units.
std::optional<EncodedGof> encode_with_model(const SkinnedContext& context,
                                            const KeptModel& kept, const GofFrames& frames,
                                            double step, double most);

}  // namespace rlpc
