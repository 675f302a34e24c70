// What programs say of files.
#pragma once

#include <string>

namespace rlpc {

// The path, or "standard input" for "-".
inline std::string name_of_input(const std::string& path) {
  return path == "-" ? "standard input" : path;
}

}  // namespace rlpc
