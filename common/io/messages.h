// What programs say on a terminal, of names and texts that others chose.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rlpc {

// The path, or "standard input" for "-".
inline std::string name_of_input(const std::string& path) {
  return path == "-" ? "standard input" : path;
}

// Text as UTF-8 that does nothing to a terminal: control characters, those that turn the
// direction of writing, and bytes that are no UTF-8 are shown as \x1B. A text of one line:
std::string printable(std::string_view text);
// Line ends and tabs stay.
std::string printable_lines(std::string_view text);

// "500 MiB" where it is as round as that, else "123456 bytes".
std::string size_text(std::uint64_t bytes);

// "TOOL: MESSAGE" in a line of standard error, printable.
void print_message(std::string_view tool, std::string_view message);

}  // namespace rlpc
