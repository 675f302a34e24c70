// Numbered file names, from a pattern with one "%d" or "%04d" (any width) in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace rlpc {

struct NumberedName {
  std::string prefix;
  std::string suffix;
  std::size_t width = 0;  // padded with zeros to this many digits

  std::string with(std::uint64_t number) const;
  // The number for which with() gives this name.
  std::optional<std::uint64_t> number_of(const std::string& name) const;
};

// Nothing if it is no such pattern; "%4d", which would pad with blanks, is none.
std::optional<NumberedName> parse_pattern(const std::string& pattern);

}  // namespace rlpc
