// Standard output, which programs forget to look at when they end.
#pragma once

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "decoder/tools/exit_code.h"

namespace rlpc {

// `code`, or that of failed output if not all of standard output could be written.
inline int after_standard_output(const char* tool, int code, int failed = kExitIo) {
  errno = 0;
  const bool good = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (good || code != kExitDone) return code;
  std::fprintf(stderr, "%s: cannot write to standard output: %s\n", tool,
               std::generic_category().message(errno == 0 ? EIO : errno).c_str());
  return failed;
}

}  // namespace rlpc
