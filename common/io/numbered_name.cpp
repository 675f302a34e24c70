#include "common/io/numbered_name.h"

#include <charconv>
#include <system_error>

namespace rlpc {
namespace {

constexpr std::size_t kMaxWidth = 19;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

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
  if (percent == pattern.npos) return std::nullopt;
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

}  // namespace rlpc
