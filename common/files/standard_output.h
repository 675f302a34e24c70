// Checks standard output when a program ends.
#pragma once

namespace rlpc {

// Ends the process by SIGPIPE if a pipe that it wrote to was closed. If `code` is 0 and
// standard output could not be written completely, reports this on standard error and returns
// `failed`. Otherwise returns `code`.
int after_standard_output(const char* tool, int code, int failed);

}  // namespace rlpc
