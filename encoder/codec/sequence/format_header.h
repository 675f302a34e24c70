// The sequence header of frames that arrive one by one.
#pragma once

#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/frame_format.h"
#include "encoder/codec/settings.h"

namespace rlpc {

// Returns the header without level and grid. The format and the settings have been checked.
SequenceHeader header_of(const FrameFormat& format, const EncoderSettings& settings);

// Sets the grid for all coordinates in the box of the format. finest_error: the RMS error, in
// units, that the first frames need; later ones can have errors that are 16 times smaller.
void set_grid_of_box(SequenceHeader& header, const FrameFormat& format, const Target& target,
                     double finest_error);

}  // namespace rlpc
