// Checks of rlpc_frame_output for all functions that write frames.
#pragma once

#include <string>

#include "decoder/c_api/convert_frame.h"
#include "decoder/c_api/decoder_handle.h"

namespace rlpc {

// Sets the error of the handle, and returns RLPC_BAD_ARGUMENT.
rlpc_status bad_output(rlpc_decoder& handle, const std::string& what);
// Returns RLPC_OK if the output has formats and buffers for the vertices of a frame; otherwise
// sets the error of the handle.
rlpc_status check_output(rlpc_decoder& handle, const rlpc_frame_output& output);
// Returns the scale of RLPC_FORMAT_INT16 positions in the output, or the one that covers the
// grid.
Int16Scale scale_of(const rlpc_frame_output& output, const SequenceHeader& header);

}  // namespace rlpc
