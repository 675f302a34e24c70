// The choice of prediction tools for a skinned GOF.
#pragma once

#include "encoder/skinned_gof/search/skinned_context.h"
#include "encoder/skinned_gof/search/skinned_trial.h"

namespace rlpc {

// The best trial with the bones of this one.
SkinnedTrial search_tools(const SkinnedContext& context, const SkinnedTrials& trials,
                          SkinnedTrial best);

}  // namespace rlpc
