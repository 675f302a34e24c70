// Characters of ASCII, whatever the locale.
#pragma once

namespace rlpc {

// Returns whether c is one of 0 to 9.
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace rlpc
