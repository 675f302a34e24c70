// Standard output, which programs forget to look at when they end.
#pragma once

namespace rlpc {

// `code`; or `failed`, said on standard error, where `code` is 0 but not all of standard output
// could be written.
int after_standard_output(const char* tool, int code, int failed);

}  // namespace rlpc
