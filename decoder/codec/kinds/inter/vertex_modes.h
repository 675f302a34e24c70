// Counts the vertices of each frame that follow the motion of their patch (8.19.5).
#pragma once

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/memory/owned.h"
#include "decoder/codec/summary/gof_summary.h"

namespace rlpc {

// Returns the modes [num_frames]; empty if the GOF has no patches.
Vector<VertexModes> vertex_modes(const InterGof& gof);

}  // namespace rlpc
