// Checks of rlpc_frame_output, for all functions that give frames.
#pragma once

#include <string>

#include "decoder/c_api/convert_frame.h"
#include "decoder/c_api/decoder_handle.h"

namespace rlpc {

// Sets the error of the handle.
rlpc_status bad_output(rlpc_decoder& handle, const std::string& what);
// Whether the output has formats and buffers for the vertices of a frame.
rlpc_status check_output(rlpc_decoder& handle, const rlpc_frame_output& output);
// The scale of RLPC_INT16 that the output asks for, or the one that holds every position.
Int16Scale scale_of(const rlpc_frame_output& output, const SequenceHeader& header);

}  // namespace rlpc
