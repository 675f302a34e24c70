// 8.17.3 Temporal layers: divides the tracks of a GOF into them, and leaves some out.
#pragma once

#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

// The GOF gets this many temporal layers, all with their slices; 1 to track_levels + 1. Its
// other slices are set.
void set_temporal_layers(int temporal_layers, SkinnedGof& gof);

// The GOF as it is decoded if only the first `layers` temporal layers, at least 1, are there.
SkinnedGof without_layers(SkinnedGof gof, int layers);

}  // namespace rlpc
