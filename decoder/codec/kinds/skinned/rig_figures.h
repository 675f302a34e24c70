// Figures of the rig of a skinned GOF or of a shared rig.
#pragma once

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "decoder/codec/summary/gof_summary.h"

namespace rlpc {

// Adds them to a summary that has its slices.
void add_rig_figures(const SharedRig& rig, SlicedSummary& summary);

}  // namespace rlpc
