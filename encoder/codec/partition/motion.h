// Clusters vertices by their motion.
#pragma once

#include <cstdint>

#include "encoder/codec/partition/graph.h"
#include "encoder/codec/partition/partition.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Makes parts in which one affine motion from the first frame to each other one leaves small
// errors, as in registration-based coding. A part begins where the error is largest, with the
// motion of the vertices around; then motions are fitted to parts, and vertices move to better
// adjacent parts, in turn, as in Lloyd's algorithm. There are fewer parts if fewer leave no
// error.
//
//   frames  at least two
//   graph   of the mesh, connected
//   count   1 to kMaxParts
Partition motion_partition(const SpanFrames& frames, const Graph& graph, std::uint32_t count);

}  // namespace rlpc
