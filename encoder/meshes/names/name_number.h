// Numbers in file names: their places and values.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rlpc {

// A number as it is written in a name, of any size. Refers to the text of the name.
struct NameNumber {
  char sign = '\0';             // '-', '+' or none
  std::string_view whole;       // digits, perhaps with leading zeros
  std::string_view fraction{};  // digits after a point or comma; empty: none

  // Returns an approximate value, near enough to find gaps.
  double value() const;
  // Returns the digits without leading zeros; empty for 0.
  std::string_view significant() const;
};

// Compares by value.
bool is_less(const NameNumber& a, const NameNumber& b);

// Parses all of `text` as a number: "7", "-005", "1.25"; none: it is something else.
std::optional<NameNumber> parse_name_number(std::string_view text);

// A name around a number.
struct NameForm {
  std::string_view before;
  std::string_view after;

  // Returns the number of a name of this form, with its extension in upper or lower case; none:
  // it has another form.
  std::optional<NameNumber> number_of(std::string_view name) const;
};

// Returns every way to read a number in a name: each run of digits with and without the sign
// before it and the fraction after it.
std::vector<NameForm> forms_of(std::string_view name);

bool is_sign(char c);
// Returns the bytes of the sign that ends before `at`; 0: no sign.
std::size_t sign_length_before(std::string_view text, std::size_t at);
// Whether a byte is a digit, an ASCII letter or part of a longer UTF-8 character.
bool is_part_of_word(char c);

// A name with a date in it, as in 2026-01-31 or 20260131_235959.
struct DatedName {
  std::string digits;  // digits of date and time; later ones are greater
  std::string form;    // the name without these digits
};
std::optional<DatedName> find_date(std::string_view name);

}  // namespace rlpc
