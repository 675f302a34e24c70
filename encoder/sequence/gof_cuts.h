// Where a sequence is cut into GOFs.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/input/frame_source.h"

namespace rlpc {

struct GofSpan {
  std::uint32_t first;
  std::uint32_t count;
};

// As few GOFs as can be, none longer than `longest`, of equal lengths but for one frame.
std::vector<GofSpan> equal_gofs(std::uint32_t num_frames, std::uint32_t longest);

// GOFs, none longer than `longest`, that are expected to cost least: cut where the animation
// turns to other motions. Equal ones unless others are clearly better. The frames are read
// once, of which a sample of vertices is kept; time is linear in frames. Very long sequences
// have equal ones, as so little of each frame could be kept.
//
//   step  of the quantisers that is likely, in units of the coordinates
InputResult<std::vector<GofSpan>> cheapest_gofs(FrameSource& source, std::uint32_t longest,
                                                double step);

}  // namespace rlpc
