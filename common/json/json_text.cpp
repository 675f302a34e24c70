#include "common/json/json_text.h"

#include <array>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

class JsonScanner {
 public:
  // shape: null to count nothing and to allow any depth.
  explicit JsonScanner(std::string_view text, JsonShape* shape = nullptr)
      : text_(text), shape_(shape) {}

  bool scan();
  std::size_t position() const { return pos_; }
  bool is_too_deep() const { return too_deep_; }

 private:
  // Returns the next byte; -1 at the end.
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
  bool open(char close);
  void close();
  void count_element();
  void count_member(std::size_t name_bytes);

  std::string_view text_;
  std::size_t pos_ = 0;
  Vector<char> open_;  // closing brackets due, if depth is not limited
  JsonShape* shape_;
  std::size_t depth_ = 0;
  std::array<char, kMaxJsonDepth> due_{};  // closing brackets due, if depth is limited
  std::array<std::uint64_t, kMaxJsonDepth> members_{};  // members so far of the open objects
  bool too_deep_ = false;
};

bool JsonScanner::open(char close) {
  if (shape_ == nullptr) return open_.push_back(close), ++depth_, true;
  if (depth_ == kMaxJsonDepth) return too_deep_ = true, false;
  due_[depth_] = close;
  members_[depth_++] = 0;
  return true;
}

void JsonScanner::close() {
  if (shape_ == nullptr) open_.pop_back();
  --depth_;
}

void JsonScanner::count_element() {
  if (shape_ == nullptr || depth_ == 0 || due_[depth_ - 1] != ']') return;
  ++shape_->elements;
  shape_->levels += depth_;
}

void JsonScanner::count_member(std::size_t name_bytes) {
  if (shape_ == nullptr) return;
  constexpr std::size_t kBytesAtOnce = 32;
  ++shape_->members;
  shape_->levels += depth_;
  shape_->comparisons += members_[depth_ - 1]++ * (1 + name_bytes / kBytesAtOnce);
}

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

// Scans a character by RFC 3629: not overlong, not a surrogate, not above U+10FFFF.
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
      if (shape_ != nullptr) ++shape_->blocks;
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
  const std::size_t first = pos_;
  if (!string()) return false;
  count_member(pos_ - first);
  skip_space();
  return take(':');
}

// Scans a value, or the beginning of an array or object.
bool JsonScanner::begin_value(bool& complete) {
  skip_space();
  count_element();
  const bool object = next() == '{';
  if (!object && next() != '[') return complete = true, scalar();
  if (shape_ != nullptr) ++shape_->blocks;
  const char close_by = object ? '}' : ']';
  if (!open(close_by)) return false;
  ++pos_;
  skip_space();
  complete = take(close_by);
  if (complete) return close(), true;
  return !object || key();
}

// Scans what follows a value; incomplete if another value is due.
bool JsonScanner::end_value(bool& complete) {
  for (;;) {
    skip_space();
    if (depth_ == 0) return complete = true, pos_ == text_.size();
    const char due = shape_ == nullptr ? open_.back() : due_[depth_ - 1];
    if (take(',')) return complete = false, due == ']' || key();
    if (!take(due)) return false;
    close();
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

std::optional<JsonFault> measure_json(std::string_view text, JsonShape& shape) {
  shape = {};
  JsonScanner scanner(text, &shape);
  if (scanner.scan()) return std::nullopt;
  return JsonFault{scanner.is_too_deep(), scanner.position()};
}

// Values take 16 bytes in arrays and 48 in objects, whose capacity doubles: up to twice that,
// and half as much again while it grows. Strings, arrays and objects take 32 bytes in another
// block, and 16 of the allocator's for that block and for their contents. An object that grows
// copies its contents once. Characters are in the buffer of the parser, in strings whose
// capacity may be double, and in a copy; a printed text is also a string that doubles. Each
// value can have a line of the text, and its brackets another.
std::uint64_t json_tree_bytes(const JsonShape& shape, std::size_t text_bytes) {
  constexpr std::uint64_t kElementBytes = 64;
  constexpr std::uint64_t kMemberBytes = 240;
  constexpr std::uint64_t kBlockBytes = 160;
  constexpr std::uint64_t kLevelBytes = 12;
  constexpr std::uint64_t kEscapedBytes = 12;
  return kElementBytes * shape.elements + kMemberBytes * shape.members +
         kBlockBytes * shape.blocks + kLevelBytes * shape.levels + kEscapedBytes * text_bytes;
}

}  // namespace rlpc
