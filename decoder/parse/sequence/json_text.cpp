#include "decoder/parse/sequence/json_text.h"

#include "common/owned.h"

namespace rlpc {
namespace {

class JsonScanner {
 public:
  explicit JsonScanner(std::string_view text) : text_(text) {}

  bool scan();
  std::size_t position() const { return pos_; }

 private:
  // -1 at the end.
  int next() const {
    return pos_ < text_.size() ? static_cast<unsigned char>(text_[pos_]) : -1;
  }
  bool take(char c) {
    if (next() != c) return false;
    ++pos_;
    return true;
  }
  bool take_word(std::string_view word) {
    for (const char c : word) {
      if (!take(c)) return false;
    }
    return true;
  }
  void skip_space() {
    while (take(' ') || take('\t') || take('\n') || take('\r')) {
    }
  }
  bool take_digits();
  bool number();
  bool string();
  bool escape();
  bool utf8_character();
  bool scalar();
  bool key();
  bool begin_value(bool& complete);
  bool end_value(bool& complete);

  std::string_view text_;
  std::size_t pos_ = 0;
  Vector<char> open_;  // the closing brackets due; nesting depth is not limited
};

bool JsonScanner::take_digits() {
  const std::size_t first = pos_;
  while (next() >= '0' && next() <= '9') ++pos_;
  return pos_ > first;
}

bool JsonScanner::number() {
  take('-');
  if (!take('0') && !take_digits()) return false;
  if (take('.') && !take_digits()) return false;
  if (take('e') || take('E')) {
    if (!take('+')) take('-');
    return take_digits();
  }
  return true;
}

bool JsonScanner::escape() {
  if (take('u')) {
    for (int i = 0; i < 4; ++i) {
      const int c = next();
      const bool hex =
          (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
      if (!hex) return false;
      ++pos_;
    }
    return true;
  }
  const int c = next();
  if (c < 0 ||
      std::string_view("\"\\/bfnrt").find(static_cast<char>(c)) == std::string_view::npos) {
    return false;
  }
  ++pos_;
  return true;
}

// RFC 3629: not overlong, not a surrogate, not above U+10FFFF.
bool JsonScanner::utf8_character() {
  const int lead = next();
  if (lead < 0x80) return ++pos_, true;
  if (lead < 0xC2 || lead > 0xF4) return false;
  ++pos_;
  const int more = lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : 3;
  for (int i = 0; i < more; ++i) {
    int low = 0x80;
    int high = 0xBF;
    if (i == 0 && lead == 0xE0) low = 0xA0;
    if (i == 0 && lead == 0xED) high = 0x9F;
    if (i == 0 && lead == 0xF0) low = 0x90;
    if (i == 0 && lead == 0xF4) high = 0x8F;
    if (next() < low || next() > high) return false;
    ++pos_;
  }
  return true;
}

bool JsonScanner::string() {
  if (!take('"')) return false;
  while (!take('"')) {
    if (take('\\')) {
      if (!escape()) return false;
    } else if (next() < 0x20 || !utf8_character()) {
      return false;
    }
  }
  return true;
}

bool JsonScanner::scalar() {
  switch (next()) {
    case '"':
      return string();
    case 't':
      return take_word("true");
    case 'f':
      return take_word("false");
    case 'n':
      return take_word("null");
    default:
      return number();
  }
}

bool JsonScanner::key() {
  skip_space();
  if (!string()) return false;
  skip_space();
  return take(':');
}

// A value, or the beginning of an array or object.
bool JsonScanner::begin_value(bool& complete) {
  skip_space();
  const bool object = next() == '{';
  if (!object && next() != '[') return complete = true, scalar();
  ++pos_;
  skip_space();
  const char close = object ? '}' : ']';
  complete = take(close);
  if (complete) return true;
  open_.push_back(close);
  return !object || key();
}

// What follows a value; incomplete if another one is due.
bool JsonScanner::end_value(bool& complete) {
  for (;;) {
    skip_space();
    if (open_.empty()) return complete = true, pos_ == text_.size();
    if (take(',')) return complete = false, open_.back() == ']' || key();
    if (!take(open_.back())) return false;
    open_.pop_back();
  }
}

bool JsonScanner::scan() {
  for (;;) {
    bool complete = false;
    if (!begin_value(complete)) return false;
    if (!complete) continue;
    if (!end_value(complete)) return false;
    if (complete) return true;
  }
}

}  // namespace

std::optional<std::size_t> find_json_error(std::string_view text) {
  JsonScanner scanner(text);
  if (scanner.scan()) return std::nullopt;
  return scanner.position();
}

}  // namespace rlpc
