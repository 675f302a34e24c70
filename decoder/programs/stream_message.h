// Formats stream errors as the programs report them.
#pragma once

#include <string>

#include "decoder/rlpc_decoder.h"

namespace rlpc {

// One line: the file and what is wrong with it. Names the option that sets an exceeded limit,
// and the format of a file that is no stream.
std::string stream_message(const std::string& path, const Error& error,
                           const DecodeLimits& limits);

}  // namespace rlpc
