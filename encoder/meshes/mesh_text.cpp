#include "encoder/meshes/mesh_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>

namespace rlpc {

namespace {

// Whether a number outside the range of floats is too small rather than too large.
bool rounds_to_zero(const char* first, const char* last) {
  double value = 0;
  if (std::from_chars(first, last, value).ec == std::errc()) return std::abs(value) < 1;
  const std::string_view word(first, static_cast<std::size_t>(last - first));
  return word.find("e-") != word.npos || word.find("E-") != word.npos;
}

}  // namespace

std::string_view TextWords::next() {
  skip_blanks();
  const std::size_t first = pos_;
  if (first < text_.size() && text_[first] == '#') return {};
  while (pos_ < text_.size() && !is_blank(text_[pos_]) && !is_line_end(text_[pos_]) &&
         continuation_length() == 0) {
    ++pos_;
  }
  return text_.substr(first, pos_ - first);
}

std::string_view TextWords::next_of_any_line() {
  std::string_view word = next();
  while (word.empty() && !at_end()) {
    next_line();
    word = next();
  }
  return word;
}

std::string TextWords::rest_of_words() {
  std::string text;
  for (std::string_view word = next(); !word.empty(); word = next()) {
    if (!text.empty()) text += ' ';
    text += word;
  }
  return text;
}

std::string_view TextWords::rest() {
  const std::size_t first = pos_;
  while (pos_ < text_.size() && !is_line_end(text_[pos_])) ++pos_;
  return text_.substr(first, pos_ - first);
}

void TextWords::next_line() {
  while (!next().empty()) {
  }
  rest();
  if (!at_end()) pos_ += line_end_length(pos_);
  ++line_;
}

std::size_t TextWords::line_end_length(std::size_t at) const {
  return text_[at] == '\r' && at + 1 < text_.size() && text_[at + 1] == '\n' ? 2 : 1;
}

// Returns the bytes of a backslash and line end at pos_; 0 if there is none.
std::size_t TextWords::continuation_length() const {
  if (text_[pos_] != '\\' || pos_ + 1 >= text_.size() || !is_line_end(text_[pos_ + 1]))
    return 0;
  return 1 + line_end_length(pos_ + 1);
}

void TextWords::skip_blanks() {
  while (pos_ < text_.size()) {
    if (is_blank(text_[pos_])) {
      ++pos_;
    } else if (const std::size_t n = continuation_length(); n > 0) {
      pos_ += n;
      ++line_;
    } else {
      return;
    }
  }
}

std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text = "\"";
  for (const char c : word.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > kLongest ? "...\"" : "\"");
}

float parse_coordinate(std::string_view word, std::optional<std::string>& problem,
                       double* left) {
  const char* const first = word.data() + (word.starts_with('+') && word.size() > 1 ? 1 : 0);
  const char* const last = word.data() + word.size();
  float value = 0;
  const auto [end, ec] = std::from_chars(first, last, value);
  if (end != last || ec == std::errc::invalid_argument) {
    problem = quoted(word) + " is not a number";
  } else if (ec == std::errc::result_out_of_range) {
    if (rounds_to_zero(first, last)) return 0;
    problem = quoted(word) + " is too large for a 32-bit float (3.4e38)";
  } else if (!std::isfinite(value)) {
    problem = quoted(word) + " is not finite; every coordinate must be";
  } else if (left != nullptr) {
    double exact = value;
    std::from_chars(first, last, exact);
    *left = exact - static_cast<double>(value);
  }
  return value;
}

std::optional<double> parse_number(std::string_view word) {
  const std::string text(word);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string shortest_text(float x) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), x);
  return {text.data(), end};
}

}  // namespace rlpc
