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
  // Returns the number for which with() returns a name; none if there is none.
  std::optional<std::uint64_t> number_of(const std::string& name) const;
};

// Parses a pattern; none if it is invalid, such as "%4d", which would pad with blanks. In a
// name without "%", one run of "#" stands for as many digits or more, as in animation programs.
std::optional<NumberedName> parse_pattern(const std::string& pattern);

// Returns whether a file name is meant as a pattern, valid or not: it has a "%", or one run of
// "#".
bool is_pattern(const std::string& name);

// Returns a remedy for messages about invalid patterns such as "%4d": "; for %4d, write %04d".
// Empty for others.
std::string advice_on_pattern(const std::string& name);

}  // namespace rlpc
