#include "common/files/numbered_name.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "common/files/ascii.h"

namespace rlpc {
namespace {

constexpr std::size_t kMaxWidth = 19;

// Parses a name with one run of "#".
std::optional<NumberedName> parse_run(const std::string& name) {
  const std::size_t first = name.find('#');
  if (first == name.npos) return std::nullopt;
  const std::size_t end = std::min(name.find_first_not_of('#', first), name.size());
  if (end - first > kMaxWidth || name.find('#', end) != name.npos) return std::nullopt;
  return NumberedName{name.substr(0, first), name.substr(end), end - first};
}

}  // namespace

std::string NumberedName::with(std::uint64_t number) const {
  std::string digits = std::to_string(number);
  if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
  return prefix + digits + suffix;
}

std::optional<std::uint64_t> NumberedName::number_of(const std::string& name) const {
  if (name.size() <= prefix.size() + suffix.size()) return std::nullopt;
  std::uint64_t number = 0;
  const char* const first = name.data() + prefix.size();
  const char* const last = name.data() + name.size() - suffix.size();
  const auto [end, ec] = std::from_chars(first, last, number);
  if (ec != std::errc() || end != last || with(number) != name) return std::nullopt;
  return number;
}

std::optional<NumberedName> parse_pattern(const std::string& pattern) {
  const std::size_t percent = pattern.find('%');
  if (percent == pattern.npos) return parse_run(pattern);
  NumberedName result;
  std::size_t pos = percent + 1;
  const bool zeros = pos < pattern.size() && pattern[pos] == '0';
  while (pos < pattern.size() && is_digit(pattern[pos]) && result.width <= kMaxWidth) {
    result.width = 10 * result.width + static_cast<std::size_t>(pattern[pos++] - '0');
  }
  if (pos == pattern.size() || pattern[pos] != 'd' || result.width > kMaxWidth) {
    return std::nullopt;
  }
  if (!zeros && result.width > 0) return std::nullopt;  // would pad with blanks
  result.prefix = pattern.substr(0, percent);
  result.suffix = pattern.substr(pos + 1);
  if (result.suffix.find('%') != result.suffix.npos) return std::nullopt;
  return result;
}

bool is_pattern(const std::string& name) {
  return name.find('%') != name.npos || parse_run(name).has_value();
}

std::string advice_on_pattern(const std::string& name) {
  for (std::size_t at = 0; (at = name.find('%', at)) != name.npos; ++at) {
    const std::size_t end = std::min(name.find_first_not_of("0123456789", at + 1), name.size());
    if (end == at + 1 || name[at + 1] == '0' || end == name.size() || name[end] != 'd')
      continue;
    const std::string width = name.substr(at + 1, end - at - 1);
    return "; for %" + width + "d, which pads with blanks, write %0" + width + "d";
  }
  return "";
}

}  // namespace rlpc
