// Prints messages on a terminal safely, even if they quote untrusted names and text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rlpc {

// A path for messages: "standard input" for "-".
inline std::string name_of_input(const std::string& path) {
  return path == "-" ? "standard input" : path;
}

// Text as UTF-8 that is safe to print: control characters, directional controls and
// invalid UTF-8 are escaped as \x1B. For a single line:
std::string printable(std::string_view text);
// The same, but keeps line ends and tabs.
std::string printable_lines(std::string_view text);

// A number of bytes: "500 MiB" if exact, otherwise "123456 bytes".
std::string size_text(std::uint64_t bytes);

// Prints "TOOL: MESSAGE", escaped, as a line of standard error.
void print_message(std::string_view tool, std::string_view message);

}  // namespace rlpc
