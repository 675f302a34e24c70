// Splits text mesh formats into words and numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rlpc {

// Splits text into lines and words. A backslash at the end of a line continues it; "#" at the
// start of a word ends it. Lines end with LF, CR LF or CR.
class TextWords {
 public:
  explicit TextWords(std::string_view text, std::uint64_t first_line = 1)
      : text_(text), line_(first_line) {}

  bool at_end() const { return pos_ == text_.size(); }
  std::uint64_t line() const { return line_; }
  // Returns the next word of this line; empty at its end.
  std::string_view next();
  // Returns the next word of this or a later line; empty at the end.
  std::string_view next_of_any_line();
  // Returns the remaining words of this line, with a blank between them.
  std::string rest_of_words();
  // Returns the rest of this line, including any comment.
  std::string_view rest();
  void next_line();
  // Returns the position, bytes from the start of the text.
  std::size_t position() const { return pos_; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  std::size_t line_end_length(std::size_t at) const;
  std::size_t continuation_length() const;
  void skip_blanks();

  std::string_view text_;
  std::size_t pos_ = 0;
  std::uint64_t line_;
};

// Returns a word for error messages: quoted, made printable, and shortened.
std::string quoted(std::string_view word);

// Parses all of `word` as a finite float, correctly rounded; otherwise sets `problem`. left: if
// given, set to the number minus the float.
float parse_coordinate(std::string_view word, std::optional<std::string>& problem,
                       double* left = nullptr);

// Returns all of `word` as a finite number; none: it is not one.
std::optional<double> parse_number(std::string_view word);

// Returns the shortest text that parse_coordinate() reads as the same number.
std::string shortest_text(float x);

}  // namespace rlpc
