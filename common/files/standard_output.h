// Checks standard output when a program ends.
#pragma once

namespace rlpc {

// Ends the process by SIGPIPE if a pipe that it wrote to was closed. Otherwise returns `code`.
// But if that is 0 and standard output could not be written completely, reports this on
// standard error and returns `failed`.
int after_standard_output(const char* tool, int code, int failed);

}  // namespace rlpc
