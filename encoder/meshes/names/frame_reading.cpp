#include "encoder/meshes/names/frame_reading.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/files/ascii.h"
#include "encoder/meshes/names/frame_steps.h"

namespace rlpc {

namespace {

// Whether a hyphen that ends at `end` follows neither a separator nor the beginning.
bool follows_word(std::string_view text, std::size_t end) {
  return end > 0 && is_part_of_word(text[end - 1]);
}

// Whether numbers are frames of one take, as in take-2.0001, not times: they count in small
// steps, with four digits or more, or with three from 0 or 1 on.
bool are_frames_of_take(const Reading& reading) {
  const NameNumber& first = reading.numbers[reading.order.front()];
  const NameNumber& last = reading.numbers[reading.order.back()];
  const std::size_t digits = first.fraction.size();
  const bool is_one_take =
      !first.significant().empty() &&
      std::all_of(reading.numbers.begin(), reading.numbers.end(), [&](const NameNumber& n) {
        return n.whole == first.whole && n.fraction.size() == digits;
      });
  if (!is_one_take || digits < 3) return false;
  const FrameSteps steps = steps_of(reading);
  if (steps.regularity == Regularity::kIrregular) return false;
  const double step = steps.step * std::pow(10.0, static_cast<double>(digits));
  if (digits > 3) return step < 5.5;
  return step < 1.1 && (last.fraction == "000" || last.fraction == "001");
}

// Whether an exponent follows, as in 1e-05.
bool follows_mantissa(std::string_view before) {
  return (before.ends_with('e') || before.ends_with('E')) && before.size() > 1 &&
         is_digit(before[before.size() - 2]);
}

bool has_zero(const Reading& reading) {
  return std::any_of(reading.numbers.begin(), reading.numbers.end(),
                     [](const NameNumber& n) { return n.value() == 0.0; });
}

// Judges the signs of numbers that all have the same one, a hyphen after a word.
Signs hyphens_of(const Reading& reading) {
  if (follows_mantissa(reading.form.before)) return Signs::kDoubtful;
  if (!reading.has_fractions || are_frames_of_take(reading)) return Signs::kNone;
  return has_zero(reading) ? Signs::kUnlikely : Signs::kDoubtful;
}

// Whether fractions have one length, or no zeros at their ends, except that of 1.0.
bool are_fractions_alike(const std::vector<NameNumber>& numbers) {
  std::size_t length = 0;
  bool is_fixed = true;
  bool has_zeros = false;
  for (const NameNumber& n : numbers) {
    if (n.fraction.empty()) continue;
    if (length == 0) length = n.fraction.size();
    is_fixed = is_fixed && n.fraction.size() == length;
    has_zeros |= n.fraction.size() > 1 && n.fraction.back() == '0';
  }
  return is_fixed || !has_zeros;
}

void sort_by_number(Reading& reading) {
  std::stable_sort(reading.order.begin(), reading.order.end(),
                   [&](std::size_t a, std::size_t b) {
                     return is_less(reading.numbers[a], reading.numbers[b]);
                   });
  for (std::size_t i = 1; i < reading.order.size(); ++i) {
    reading.has_twice |=
        !is_less(reading.numbers[reading.order[i - 1]], reading.numbers[reading.order[i]]);
  }
}

// Whether the number before the point has a sign, so that no counter follows it.
bool follows_negative_number(std::string_view before) {
  std::size_t at = before.size() - 1;  // place of the point
  while (at > 0 && is_digit(before[at - 1])) --at;
  const std::size_t sign = sign_length_before(before, at);
  return sign > 0 && !follows_word(before, at - sign);
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
  sort_by_number(reading);
  return reading;
}

Signs signs_of(const Reading& reading) {
  const std::string_view before = reading.form.before;
  const auto count = [&](char sign) {
    return std::count_if(reading.numbers.begin(), reading.numbers.end(),
                         [&](const NameNumber& n) { return n.sign == sign; });
  };
  if (count('\0') == static_cast<std::ptrdiff_t>(reading.numbers.size())) {
    const std::size_t sign = sign_length_before(before, before.size());
    return sign == 0 || follows_word(before, before.size() - sign) ? Signs::kSigns
                                                                   : Signs::kNone;
  }
  if (count('\0') > 0 || (count('-') > 0 && count('+') > 0)) return Signs::kSigns;
  if (!follows_word(before, before.size())) return Signs::kSigns;
  return count('-') > 0 ? hyphens_of(reading) : Signs::kNone;
}

bool are_padded_alike(const Reading& reading) {
  const std::vector<NameNumber>& numbers = reading.numbers;
  const auto shortest = std::min_element(
      numbers.begin(), numbers.end(),
      [](const NameNumber& a, const NameNumber& b) { return a.whole.size() < b.whole.size(); });
  return std::all_of(numbers.begin(), numbers.end(), [&](const NameNumber& n) {
    return n.whole.size() == shortest->whole.size() || n.whole.front() != '0';
  });
}

bool can_be_written(const Reading& reading) {
  if (reading.has_fractions) return are_fractions_alike(reading.numbers);
  return !is_after_point(reading) ||
         (are_padded_alike(reading) && !follows_negative_number(reading.form.before));
}

std::optional<Reading> read_as_fractions(const Reading& reading) {
  std::string_view before = reading.form.before;
  for (int i = 0; i < 2 && !before.empty() && !is_digit(before.back()); ++i) {
    before.remove_suffix(1);
  }
  const bool follows_digits =
      before.size() < reading.form.before.size() && !before.empty() && is_digit(before.back());
  if (!follows_digits || is_after_point(reading)) return std::nullopt;
  Reading fractions{.form = reading.form, .numbers = {}, .order = reading.order};
  fractions.has_fractions = true;
  for (const NameNumber& n : reading.numbers) {
    if (n.sign != '\0' || !n.fraction.empty()) return std::nullopt;
    fractions.numbers.push_back({.whole = "0", .fraction = n.whole});
  }
  sort_by_number(fractions);
  return fractions;
}

bool is_after_point(const Reading& reading) {
  const std::string_view before = reading.form.before;
  return before.size() > 1 && (before.back() == '.' || before.back() == ',') &&
         is_digit(before[before.size() - 2]);
}

bool follows_version(const Reading& reading) {
  std::string_view before = reading.form.before;
  if (!before.ends_with('v') && !before.ends_with('V')) return false;
  before.remove_suffix(1);
  return before.empty() || is_digit(before.back()) || !is_part_of_word(before.back());
}

}  // namespace rlpc
