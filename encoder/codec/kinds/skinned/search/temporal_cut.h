// 8.17.3 Temporal layers: divides the tracks of a GOF into them, and leaves some out.
#pragma once

#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

// Divides the GOF into this many temporal layers, 1 to track_levels + 1, all with their slices.
// Its other slices must be set.
void set_temporal_layers(int temporal_layers, SkinnedGof& gof);

// Returns the GOF as it is decoded with only the first `layers` temporal layers, at least 1.
SkinnedGof without_layers(SkinnedGof gof, int layers);

}  // namespace rlpc
