#include "common/files/standard_output.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "common/files/interrupts.h"

namespace rlpc {

int after_standard_output(const char* tool, int code, int failed) {
  errno = 0;
  const bool good = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  end_if_pipe_was_closed();
  if (good || code != 0) return code;
  std::fprintf(stderr, "%s: cannot write to standard output: %s\n", tool,
               std::generic_category().message(errno == 0 ? EIO : errno).c_str());
  return failed;
}

}  // namespace rlpc
