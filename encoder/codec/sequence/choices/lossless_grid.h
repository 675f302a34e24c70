// Chooses the grid of a sequence that is coded without loss.
#pragma once

#include "encoder/codec/sequence/choices/grid_choice.h"

namespace rlpc {

// The coarsest grid that all coordinates of the source lie on. Reads every frame once. extent:
// as measured. Errors: those of the source; there is no such grid within the limits of the
// format, with the coordinate that needs the finest.
InputResult<GridChoice> grid_of_source(FrameSource& source, const Extent& extent);

// The finest grid on which the positions of the box, rounded to it, have at most this number of
// bits, 2 to 24, and whose origin the format can hold.
GridChoice grid_of_bits(const Extent& extent, int position_bits);

}  // namespace rlpc
