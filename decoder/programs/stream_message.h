// Formats stream errors as the programs report them.
#pragma once

#include <string>

#include "decoder/rlpc_decoder.h"

namespace rlpc {

// Returns one line: the file and its error. Names the option that sets an exceeded limit, and
// the format of a file that is not a stream.
std::string stream_message(const std::string& path, const Error& error,
                           const DecodeLimits& limits);

}  // namespace rlpc
