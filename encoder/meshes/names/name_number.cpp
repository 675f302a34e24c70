#include "encoder/meshes/names/name_number.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

#include "common/files/ascii.h"

namespace rlpc {

namespace {

// U+2212, which some programs write.
constexpr std::string_view kMinus = "\xE2\x88\x92";

char lower(char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); }

std::size_t end_of_digits(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

// Compares digits before the point.
int compare_whole(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

std::string_view without_zeros_at_end(std::string_view digits) {
  while (digits.ends_with('0')) digits.remove_suffix(1);
  return digits;
}

// Whether two suffixes are the same except for the case of their extension.
bool same_suffix(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  const std::size_t point = std::min(a.rfind('.'), a.size());
  if (a.substr(0, point) != b.substr(0, point)) return false;
  return std::equal(a.begin() + static_cast<std::ptrdiff_t>(point), a.end(),
                    b.begin() + static_cast<std::ptrdiff_t>(point),
                    [](char x, char y) { return lower(x) == lower(y); });
}

// Reads fixed numbers of digits one after the other.
class DateScanner {
 public:
  DateScanner(std::string_view text, std::size_t at) : text_(text), at_(at) {}

  // Takes `count` digits of a value in this range. Returns false if there is something else.
  bool take(std::size_t count, int min, int max) {
    if (end_of_digits(text_, at_) < at_ + count) return false;
    int value = 0;
    std::from_chars(text_.data() + at_, text_.data() + at_ + count, value);
    if (value < min || value > max) return false;
    digits_ += text_.substr(at_, count);
    at_ += count;
    return true;
  }
  // Takes one of these characters, if it is there.
  char take_separator(std::string_view characters) {
    if (at_ >= text_.size() || characters.find(text_[at_]) == characters.npos) return '\0';
    return text_[at_++];
  }
  bool is_between_digits() const { return at_ < text_.size() && is_digit(text_[at_]); }
  std::size_t position() const { return at_; }
  const std::string& digits() const { return digits_; }

 private:
  std::string_view text_;
  std::size_t at_;
  std::string digits_;
};

// A time of day after a date; moves the scanner only if there is one.
void take_time(DateScanner& scanner) {
  DateScanner time = scanner;
  time.take_separator("-_.T ");
  if (!time.take(2, 0, 23)) return;
  const char separator = time.take_separator("-_.:h");
  if (!time.take(2, 0, 59)) return;
  if (time.take_separator("-_.:m") != separator && separator != 'h') return;
  if (!time.take(2, 0, 60) || time.is_between_digits()) return;
  scanner = time;
}

std::optional<DatedName> date_at(std::string_view name, std::size_t first) {
  DateScanner scanner(name, first);
  if (!scanner.take(4, 1900, 2199)) return std::nullopt;
  const char separator = scanner.take_separator("-_.");
  if (!scanner.take(2, 1, 12)) return std::nullopt;
  if (scanner.take_separator("-_.") != separator) return std::nullopt;
  if (!scanner.take(2, 1, 31)) return std::nullopt;
  take_time(scanner);
  if (scanner.is_between_digits()) return std::nullopt;
  std::string form(name.substr(0, first));
  for (const char c : name.substr(first, scanner.position() - first)) {
    form += is_digit(c) ? '#' : c;
  }
  form += name.substr(scanner.position());
  return DatedName{scanner.digits(), form};
}

}  // namespace

std::size_t sign_length_before(std::string_view text, std::size_t at) {
  if (at > 0 && is_sign(text[at - 1])) return 1;
  return text.substr(0, at).ends_with(kMinus) ? kMinus.size() : 0;
}

bool is_sign(char c) { return c == '-' || c == '+'; }

bool is_part_of_word(char c) {
  const char l = lower(c);
  return is_digit(c) || (l >= 'a' && l <= 'z') || static_cast<unsigned char>(c) >= 0x80;
}

double NameNumber::value() const {
  const std::string text = std::string(whole) + "." + std::string(fraction) + "0";
  double size = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
  if (error != std::errc()) size = std::numeric_limits<double>::max();  // 309 digits or more
  return sign == '-' ? -size : size;
}

std::string_view NameNumber::significant() const {
  return whole.substr(std::min(whole.find_first_not_of('0'), whole.size()));
}

bool is_less(const NameNumber& a, const NameNumber& b) {
  const auto is_zero = [](const NameNumber& n) {
    return n.significant().empty() && without_zeros_at_end(n.fraction).empty();
  };
  const bool a_negative = a.sign == '-' && !is_zero(a);
  const bool b_negative = b.sign == '-' && !is_zero(b);
  if (a_negative != b_negative) return a_negative;
  int order = compare_whole(a.significant(), b.significant());
  if (order == 0) {
    order = without_zeros_at_end(a.fraction).compare(without_zeros_at_end(b.fraction));
  }
  return a_negative ? order > 0 : order < 0;
}

std::optional<NameNumber> parse_name_number(std::string_view text) {
  NameNumber number;
  if (text.starts_with(kMinus)) {
    number.sign = '-';
    text.remove_prefix(kMinus.size());
  } else if (!text.empty() && is_sign(text[0])) {
    number.sign = text[0];
    text.remove_prefix(1);
  }
  const std::size_t end = end_of_digits(text, 0);
  if (end == 0) return std::nullopt;
  number.whole = text.substr(0, end);
  if (end == text.size()) return number;
  if (text[end] != '.' && text[end] != ',') return std::nullopt;
  number.fraction = text.substr(end + 1);
  if (number.fraction.empty() || end_of_digits(number.fraction, 0) < number.fraction.size()) {
    return std::nullopt;
  }
  return number;
}

std::optional<NameNumber> NameForm::number_of(std::string_view name) const {
  if (name.size() <= before.size() + after.size() || !name.starts_with(before)) {
    return std::nullopt;
  }
  const std::size_t end = name.size() - after.size();
  if (!same_suffix(name.substr(end), after)) return std::nullopt;
  return parse_name_number(name.substr(before.size(), end - before.size()));
}

std::vector<NameForm> forms_of(std::string_view name) {
  std::vector<NameForm> forms;
  for (std::size_t at = 0; at < name.size();) {
    if (!is_digit(name[at])) {
      ++at;
      continue;
    }
    const std::size_t first = at;
    at = end_of_digits(name, first);
    std::vector<std::size_t> ends{at};
    if (at + 1 < name.size() && (name[at] == '.' || name[at] == ',') &&
        is_digit(name[at + 1])) {
      ends.push_back(end_of_digits(name, at + 1));
    }
    for (const std::size_t end : ends) {
      forms.push_back({name.substr(0, first), name.substr(end)});
      const std::size_t sign = sign_length_before(name, first);
      if (sign > 0) forms.push_back({name.substr(0, first - sign), name.substr(end)});
    }
  }
  return forms;
}

std::optional<DatedName> find_date(std::string_view name) {
  for (std::size_t at = 0; at < name.size(); ++at) {
    if (!is_digit(name[at]) || (at > 0 && is_digit(name[at - 1]))) continue;
    if (auto date = date_at(name, at)) return date;
  }
  return std::nullopt;
}

}  // namespace rlpc
