// Divides a sequence into GOFs.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/gof/gof_span.h"
#include "encoder/input/frame_source.h"

namespace rlpc {

// The GOFs of at most `longest` frames with the lowest expected cost: cut where the motion
// changes. Returns equal_gofs() unless the others are clearly cheaper. Reads each frame once
// and keeps a sample of the vertices; time is linear in frames. Very long sequences get equal
// GOFs, because the memory limit would leave too small a sample of each frame.
//
//   step  likely quantiser step, in the unit of the coordinates
//
// Errors: those of the source.
InputResult<std::vector<GofSpan>> cheapest_gofs(FrameSource& source, std::uint32_t longest,
                                                double step);

}  // namespace rlpc
