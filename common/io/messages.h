// Messages on a terminal that quote names and texts of others.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rlpc {

// The path, or "standard input" for "-".
inline std::string name_of_input(const std::string& path) {
  return path == "-" ? "standard input" : path;
}

// Text as UTF-8 that is harmless to a terminal: control characters, directional controls and
// invalid UTF-8 are escaped as \x1B. For a single line:
std::string printable(std::string_view text);
// Keeps line ends and tabs.
std::string printable_lines(std::string_view text);

// "500 MiB" if exact, otherwise "123456 bytes".
std::string size_text(std::uint64_t bytes);

// Prints "TOOL: MESSAGE", escaped, as a line of standard error.
void print_message(std::string_view tool, std::string_view message);

}  // namespace rlpc
