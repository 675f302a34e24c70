#include "decoder/output/companion_file.h"

#include <fstream>

namespace rlpc {

std::optional<OutputError> check_companion(const std::string& path, std::string_view begin,
                                           const std::string& what) {
  std::string found(begin.size(), '\0');
  std::ifstream file(path);
  file.read(found.data(), static_cast<std::streamsize>(found.size()));
  if (file.gcount() == 0 || found == begin) return std::nullopt;
  return OutputError{path + ": already exists, not written by rlpcdec; " + what +
                     " would replace it. Choose another name, or remove it"};
}

}  // namespace rlpc
