// Prints messages safely on a terminal, even if they quote untrusted names and text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rlpc {

// Returns a path for messages: "standard input" for "-".
inline std::string name_of_input(const std::string& path) {
  return path == "-" ? "standard input" : path;
}

// Returns text as UTF-8 that is safe to print on a single line: control characters, directional
// controls and invalid UTF-8 are escaped as \x1B.
std::string printable(std::string_view text);
// Returns text that is safe to print, with its line ends and tabs.
std::string printable_lines(std::string_view text);

// Formats a number of bytes exactly, in the unit that takes the fewest digits: "500 MiB" (1024
// * 1024), "500 MB" (1000 * 1000) or "123456 bytes".
std::string size_text(std::uint64_t bytes);

// Formats "1 frame", "2 frames". many: the plural, if it is not `one` with an s.
std::string count_text(std::uint64_t count, std::string_view one, std::string_view many = "");

// Prints "TOOL: MESSAGE", escaped, as a line on standard error.
void print_message(std::string_view tool, std::string_view message);

}  // namespace rlpc
