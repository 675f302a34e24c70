// Numbered file names, from a pattern with one "%d", "%04d" or "####" (any width) in it.
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

// Nothing if it is no such pattern; "%4d", which would pad with blanks, is none. One run of "#"
// stands for as many digits or more, as in animation programs, where there is no "%".
std::optional<NumberedName> parse_pattern(const std::string& pattern);

// Whether a file name is meant as a pattern, right or wrong: it has a "%", or one run of "#".
bool is_pattern(const std::string& name);

// For a message about a wrong pattern: what to write for "%4d", as in "; for %4d, write %04d";
// empty for others.
std::string advice_on_pattern(const std::string& name);

}  // namespace rlpc
