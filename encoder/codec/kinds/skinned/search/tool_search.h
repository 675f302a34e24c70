// Chooses the prediction tools of a skinned GOF.
#pragma once

#include "encoder/codec/kinds/skinned/search/skinned_context.h"
#include "encoder/codec/kinds/skinned/search/skinned_trial.h"

namespace rlpc {

// Varies the tools of `start` with the same bones. Returns the cheapest trial.
SkinnedTrial search_tools(const SkinnedContext& context, const SkinnedTrials& trials,
                          SkinnedTrial start);

}  // namespace rlpc
