#include "encoder/input/formats/frame_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace rlpc {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Whether characters before numbers are signs where the reading takes them for signs, and
// nowhere else. A sign follows a separator, or is missing in some names; the hyphen of walk-1
// follows a word.
bool are_signs_plausible(const Reading& reading) {
  const std::string_view before = reading.form.before;
  const auto is_signed = [](const NameNumber& n) { return n.sign != '\0'; };
  const auto count = std::count_if(reading.numbers.begin(), reading.numbers.end(), is_signed);
  const auto all = static_cast<std::ptrdiff_t>(reading.numbers.size());
  if (count > 0) return count < all || before.empty() || !is_part_of_word(before.back());
  const std::size_t sign = sign_length_before(before, before.size());
  if (sign == 0) return true;
  return before.size() > sign && is_part_of_word(before[before.size() - sign - 1]);
}

// Whether "v" alone stands before the number: the whole part is a version, not a frame.
bool follows_version(std::string_view before) {
  if (!before.ends_with('v') && !before.ends_with('V')) return false;
  before.remove_suffix(1);
  return before.empty() || is_digit(before.back()) || !is_part_of_word(before.back());
}

// Whether x is a whole number of parts, as many a unit as frames are usually divided into.
bool divides(const std::vector<NameNumber>& numbers, int parts, bool is_rounded) {
  return std::all_of(numbers.begin(), numbers.end(), [&](const NameNumber& n) {
    const double x = n.value() * parts;
    double rounding = is_rounded ? 0.5 * parts : 0.0;
    for (std::size_t digit = 0; digit < n.fraction.size(); ++digit) rounding /= 10.0;
    return (!is_rounded || n.fraction.size() != 1) &&
           std::abs(x - std::round(x)) <= rounding + 1e-9 * parts;
  });
}

bool are_subframes(const std::vector<NameNumber>& numbers) {
  constexpr std::array<int, 6> kExact{2, 4, 5, 8, 10, 16};
  constexpr std::array<int, 3> kRounded{3, 6, 12};  // 0.33, 0.67
  return std::any_of(kExact.begin(), kExact.end(),
                     [&](int parts) { return divides(numbers, parts, false); }) ||
         std::any_of(kRounded.begin(), kRounded.end(),
                     [&](int parts) { return divides(numbers, parts, true); });
}

bool is_even(const Reading& reading) {
  const auto values = sorted_values(reading);
  return count_gaps(values, smallest_step(values)) == 0;
}

// Digits after the point that no program writes after a number: 10 beside 9 is counted.
enum class Digits : std::uint8_t { kEither, kFraction, kCounted };

Digits kind_of_digits(const std::vector<NameNumber>& numbers) {
  std::size_t shortest = SIZE_MAX;
  for (const NameNumber& n : numbers) {
    if (!n.fraction.empty()) shortest = std::min(shortest, n.fraction.size());
  }
  bool has_zero_before = false;
  bool has_zero_behind = false;
  for (const NameNumber& n : numbers) {
    if (n.fraction.size() <= shortest || n.fraction.empty()) continue;
    has_zero_before |= n.fraction.front() == '0';
    has_zero_behind |= n.fraction.back() == '0';
  }
  if (has_zero_before == has_zero_behind) return Digits::kEither;
  return has_zero_before ? Digits::kFraction : Digits::kCounted;
}

// Whether each frame with parts after it is there itself, the first perhaps not.
bool has_whole_frames(const Reading& reading) {
  std::vector<double> whole;
  for (const NameNumber& n : reading.numbers) {
    const double value = n.value();
    if (value == std::floor(value)) whole.push_back(value);
  }
  std::sort(whole.begin(), whole.end());
  const double first = std::floor(reading.numbers[reading.order[0]].value());
  return std::all_of(reading.numbers.begin(), reading.numbers.end(), [&](const NameNumber& n) {
    const double frame = std::floor(n.value());
    return frame == first || std::binary_search(whole.begin(), whole.end(), frame);
  });
}

// Whether frames are missing, rather than others between.
bool has_few_gaps(const Reading& reading) {
  const auto values = sorted_values(reading);
  return 2 * count_gaps(values, smallest_step(values)) < values.size() - 1;
}

// Whether what stands after points or commas can be parts of frames: not the frames of versions
// or takes, as in take1.0001.
bool are_fractions_plausible(const Reading& reading) {
  return !follows_version(reading.form.before) && are_subframes(reading.numbers) &&
         kind_of_digits(reading.numbers) != Digits::kCounted &&
         (is_even(reading) || (has_few_gaps(reading) && has_whole_frames(reading)));
}

}  // namespace

std::optional<Reading> read_numbers(const NameForm& form,
                                    const std::vector<std::string>& names) {
  Reading reading{.form = form, .numbers = {}, .order = {}};
  for (const std::string& name : names) {
    const auto number = form.number_of(name);
    if (!number) return std::nullopt;
    reading.has_fractions |= !number->fraction.empty();
    reading.order.push_back(reading.numbers.size());
    reading.numbers.push_back(*number);
  }
  std::stable_sort(reading.order.begin(), reading.order.end(),
                   [&](std::size_t a, std::size_t b) {
                     return is_less(reading.numbers[a], reading.numbers[b]);
                   });
  for (std::size_t i = 1; i < names.size(); ++i) {
    reading.has_twice |=
        !is_less(reading.numbers[reading.order[i - 1]], reading.numbers[reading.order[i]]);
  }
  return reading;
}

bool is_plausible(const Reading& reading) {
  return are_signs_plausible(reading) &&
         (!reading.has_fractions || are_fractions_plausible(reading));
}

const Reading* choose_reading(const Reading& counted, const Reading& fractions) {
  if (counted.order == fractions.order) return &counted;
  const Digits digits = kind_of_digits(fractions.numbers);
  if (digits == Digits::kFraction) return &fractions;
  if (is_even(counted) == is_even(fractions)) return nullptr;
  return is_even(counted) ? &counted : &fractions;
}

std::vector<double> sorted_values(const Reading& reading) {
  std::vector<double> values;
  for (const std::size_t name : reading.order) values.push_back(reading.numbers[name].value());
  return values;
}

double smallest_step(const std::vector<double>& values) {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i) {
    step = std::min(step, values[i] - values[i - 1]);
  }
  return step;
}

std::size_t count_gaps(const std::vector<double>& values, double step) {
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] - values[i - 1] > 1.1 * step) ++gaps;
  }
  return gaps;
}

}  // namespace rlpc
