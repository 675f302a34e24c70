// Chooses the grid of a sequence that is coded without loss.
#pragma once

#include "encoder/codec/sequence/choices/grid_choice.h"

namespace rlpc {

// Returns the coarsest grid that contains all coordinates of the source. Reads every frame
// once. extent: from measure_extent(). Errors: errors of the source; no such grid within the
// limits of the format, with the coordinate that needs the finest one.
InputResult<GridChoice> grid_of_source(FrameSource& source, const Extent& extent);

// Returns the finest grid on which the positions of the box, rounded to it, have at most this
// number of bits, 2 to 24, and whose origin the format can represent.
GridChoice grid_of_bits(const Extent& extent, int position_bits);

}  // namespace rlpc
