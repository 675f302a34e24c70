#include "encoder/meshes/frame_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <system_error>
#include <utility>

namespace rlpc {

namespace {

// Parses all of `text` as a number below 2^32.
std::optional<std::uint32_t> parse_u32(std::string_view text) {
  std::uint32_t value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, ec] = std::from_chars(text.data(), last, value);
  if (ec != std::errc() || end != last) return std::nullopt;
  return value;
}

// Parses "29.97" as 2997 / 100; at most 9 digits after the point.
std::optional<FrameRate> parse_decimal(std::string_view text) {
  const std::size_t point = text.find('.');
  const std::string_view fraction = text.substr(point + 1);
  if (fraction.size() > 9) return std::nullopt;
  const auto whole = parse_u32(text.substr(0, point));
  const auto digits = fraction.empty() ? std::optional<std::uint32_t>(0) : parse_u32(fraction);
  if (!whole || !digits) return std::nullopt;
  std::uint64_t denominator = 1;
  for (std::size_t i = 0; i < fraction.size(); ++i) denominator *= 10;
  const std::uint64_t numerator = *whole * denominator + *digits;
  const std::uint64_t divisor = std::gcd(numerator, denominator);
  if (numerator / divisor > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return FrameRate{static_cast<std::uint32_t>(numerator / divisor),
                   static_cast<std::uint32_t>(denominator / divisor)};
}

std::optional<FrameRate> parse_fraction(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto numerator = parse_u32(text.substr(0, slash));
  const auto denominator =
      slash == text.npos ? std::optional<std::uint32_t>(1) : parse_u32(text.substr(slash + 1));
  if (!numerator || !denominator || *denominator == 0) return std::nullopt;
  const std::uint32_t divisor = std::gcd(*numerator, *denominator);
  return FrameRate{*numerator / divisor, *denominator / divisor};
}

// Returns the number at the end of a name: 12 for "uv12"; 0 if there is none.
std::uint32_t number_of(std::string_view name) {
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  return parse_u32(name.substr(digits)).value_or(0);
}

}  // namespace

std::optional<InputError> FrameSource::read_exact(std::uint32_t frame, std::span<double> xyz) {
  std::vector<float> floats(xyz.size());
  if (auto error = read_frame(frame, floats)) return error;
  std::copy(floats.begin(), floats.end(), xyz.begin());
  return std::nullopt;
}

void FrameSource::limit_attributes(std::size_t max) {
  auto& sets = shape_.attributes.sets;
  if (sets.size() <= max) return;
  std::string names;
  while (sets.size() > max) {
    const auto last = std::max_element(
        sets.rbegin(), sets.rend(),
        [](const auto& a, const auto& b) { return number_of(a.name) < number_of(b.name); });
    names = last->name + (names.empty() ? "" : ", ") + names;
    sets.erase(std::prev(last.base()));
  }
  add_note("dropped " + names + ": a stream has at most " + std::to_string(max) +
           " attributes");
}

InputResult<FrameRate> parse_frame_rate(std::string_view text) {
  const auto rate = text.find('.') != text.npos ? parse_decimal(text) : parse_fraction(text);
  if (rate && rate->numerator > 0) return *rate;
  return InputError{"frame rate \"" + std::string(text) +
                    "\": expected frames per second as in 25, 30000/1001 or 29.97"};
}

std::optional<FrameRate> frame_rate_near(double frames_per_second) {
  constexpr double kMin = 2.0;
  constexpr double kMax = 1000.0;
  constexpr double kNear = 1e-4;
  if (!(frames_per_second >= kMin && frames_per_second <= kMax)) return std::nullopt;
  const auto near = [&](double rate) {
    return std::abs(frames_per_second / rate - 1.0) < kNear;
  };
  const auto whole = static_cast<std::uint32_t>(std::lround(frames_per_second));
  if (near(whole)) return FrameRate{whole, 1};
  const auto slowed = static_cast<std::uint32_t>(std::lround(frames_per_second * 1.001));
  if (near(slowed / 1.001)) return FrameRate{1000 * slowed, 1001};
  const auto thousandths = static_cast<std::uint32_t>(std::lround(frames_per_second * 1000.0));
  const std::uint32_t divisor = std::gcd(thousandths, 1000U);
  return FrameRate{thousandths / divisor, 1000 / divisor};
}

}  // namespace rlpc
