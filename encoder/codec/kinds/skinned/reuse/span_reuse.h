// Encodes a span with the shared rig of an earlier one.
#pragma once

#include <optional>

#include "encoder/codec/kinds/skinned/quantise/kept_rig.h"
#include "encoder/codec/kinds/skinned/search/skinned_context.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Encodes a span without a rig of its own. None: it costs at least `max_cost` (Lagrangian
// cost), or is expected to cost far more. step: quantiser step, grid units.
std::optional<EncodedSpan> encode_with_rig(const SkinnedContext& context, const KeptRig& kept,
                                           const SpanFrames& frames, double step,
                                           double max_cost);

}  // namespace rlpc
