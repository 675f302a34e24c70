#include "encoder/obj_reader.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

#include "encoder/input_file.h"

namespace rlpc {

namespace {

// Splits text into lines and words. A backslash at the end of a line continues it; "#" at the
// start of a word ends it. Lines end with LF, CR LF or CR.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  bool at_end() const { return pos_ == text_.size(); }
  std::uint64_t line() const { return line_; }

  // The next word of this line; empty at its end.
  std::string_view next() {
    skip_blanks();
    const std::size_t first = pos_;
    if (first < text_.size() && text_[first] == '#') return {};
    while (pos_ < text_.size() && !is_blank(text_[pos_]) && !is_line_end(text_[pos_]) &&
           continuation_length() == 0) {
      ++pos_;
    }
    return text_.substr(first, pos_ - first);
  }

  // What is left of this line, comment included.
  std::string_view rest() {
    const std::size_t first = pos_;
    while (pos_ < text_.size() && !is_line_end(text_[pos_])) ++pos_;
    return text_.substr(first, pos_ - first);
  }

  void next_line() {
    while (!next().empty()) {
    }
    rest();
    if (!at_end()) pos_ += line_end_length(pos_);
    ++line_;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  std::size_t line_end_length(std::size_t at) const {
    return text_[at] == '\r' && at + 1 < text_.size() && text_[at + 1] == '\n' ? 2 : 1;
  }
  // Bytes of a backslash and line end at pos_; 0 if there is none.
  std::size_t continuation_length() const {
    if (text_[pos_] != '\\' || pos_ + 1 >= text_.size() || !is_line_end(text_[pos_ + 1]))
      return 0;
    return 1 + line_end_length(pos_ + 1);
  }
  void skip_blanks() {
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

  std::string_view text_;
  std::size_t pos_ = 0;
  std::uint64_t line_ = 1;
};

std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text = "\"";
  for (const char c : word.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > kLongest ? "...\"" : "\"");
}

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name) : words_(text), name_(name) {}

  InputResult<ObjMesh> parse() {
    for (; !words_.at_end(); words_.next_line()) {
      const std::string_view keyword = words_.next();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f") {
        read_face();
      } else if (keyword.empty()) {
        read_comment();
      }
      if (error_) return *error_;
    }
    if (mesh_.xyz.empty()) {
      return InputError{name_ + ": no vertex (no line \"v x y z\"); is this an OBJ file?"};
    }
    if (highest_index_ > num_vertices()) {
      fail(highest_line_, out_of_range(highest_index_));
      return *error_;
    }
    return std::move(mesh_);
  }

 private:
  std::int64_t num_vertices() const { return static_cast<std::int64_t>(mesh_.xyz.size() / 3); }

  void fail(std::uint64_t line, const std::string& what) {
    if (!error_) error_ = InputError{name_ + ":" + std::to_string(line) + ": " + what};
  }

  std::string out_of_range(std::int64_t index) const {
    return "vertex index " + std::to_string(index) + " is out of range 1 to " +
           std::to_string(num_vertices()) + "; is the file complete?";
  }

  // "v x y z", whatever follows.
  void read_vertex() {
    if (num_vertices() == std::numeric_limits<std::uint32_t>::max()) {
      return fail(words_.line(), "more than 2^32 - 1 vertices");
    }
    for (int axis = 0; axis < 3; ++axis) mesh_.xyz.push_back(read_float());
  }

  float read_float() {
    const std::string_view word = words_.next();
    if (word.empty()) {
      fail(words_.line(), "a vertex needs three coordinates");
      return 0;
    }
    const char* first = word.data() + (word.front() == '+' && word.size() > 1 ? 1 : 0);
    const char* const last = word.data() + word.size();
    float value = 0;
    const auto [end, ec] = std::from_chars(first, last, value);
    if (end != last || ec == std::errc::invalid_argument) {
      fail(words_.line(), quoted(word) + " is not a number");
    } else if (ec == std::errc::result_out_of_range) {
      if (rounds_to_zero(first, last)) return 0;
      fail(words_.line(), quoted(word) + " is too large for a 32-bit float (3.4e38)");
    } else if (!std::isfinite(value)) {
      fail(words_.line(), quoted(word) + " is not finite; every coordinate must be");
    }
    return value;
  }

  // Of a number that does not fit a float: too small rather than too large?
  static bool rounds_to_zero(const char* first, const char* last) {
    double value = 0;
    if (std::from_chars(first, last, value).ec == std::errc()) return std::abs(value) < 1;
    const std::string_view word(first, static_cast<std::size_t>(last - first));
    return word.find("e-") != word.npos || word.find("E-") != word.npos;
  }

  // "f a b c ...": a fan from the first corner.
  void read_face() {
    Triangle fan{};
    std::size_t corners = 0;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      const std::uint32_t vertex = parse_corner(word);
      if (error_) return;
      if (corners >= 3) fan[1] = fan[2];
      fan[corners < 2 ? corners : 2] = vertex;
      ++corners;
      if (corners >= 3) mesh_.triangles.push_back(fan);
    }
    if (corners < 3) {
      fail(words_.line(),
           "a face of " + std::to_string(corners) + " corners; it needs 3 or more");
    }
  }

  // v, v/vt, v//vn or v/vt/vn; counted from 1, or from the last vertex backwards from -1.
  std::uint32_t parse_corner(std::string_view word) {
    const char* const last = word.data() + word.size();
    std::int64_t index = 0;
    auto [end, ec] = std::from_chars(word.data(), last, index);
    bool ok = ec == std::errc();
    for (int part = 0; ok && part < 2 && end != last && *end == '/'; ++part) {
      std::int64_t unused = 0;
      const bool may_be_empty = part == 0 && end + 1 != last && end[1] == '/';
      ++end;
      if (may_be_empty) continue;
      const auto tail = std::from_chars(end, last, unused);
      ok = tail.ec == std::errc();
      end = tail.ptr;
    }
    if (!ok || end != last) {
      fail(words_.line(),
           quoted(word) + " is not a face corner; expected v, v/vt, v//vn or v/vt/vn");
      return 0;
    }
    return resolve(index);
  }

  // Zero-based; an index above the vertices read so far is checked at the end of the file.
  std::uint32_t resolve(std::int64_t index) {
    if (index == 0) fail(words_.line(), "vertex index 0; vertices are counted from 1");
    if (index > std::numeric_limits<std::uint32_t>::max() || index < -num_vertices()) {
      fail(words_.line(), index > 0 ? out_of_range(index)
                                    : "vertex index " + std::to_string(index) + ", but only " +
                                          std::to_string(num_vertices()) +
                                          " vertices come before it");
    }
    if (index > num_vertices() && index > highest_index_) {
      highest_index_ = index;
      highest_line_ = words_.line();
    }
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : num_vertices() + index);
  }

  void read_comment() {
    constexpr std::string_view kKey = "# frame_rate ";
    const std::string_view comment = words_.rest();
    if (comment.substr(0, kKey.size()) != kKey || mesh_.frame_rate) return;
    if (const auto rate = parse_frame_rate(comment.substr(kKey.size())))
      mesh_.frame_rate = *rate;
  }

  Words words_;
  const std::string& name_;
  ObjMesh mesh_;
  std::optional<InputError> error_;
  std::int64_t highest_index_ = 0;
  std::uint64_t highest_line_ = 0;
};

}  // namespace

InputResult<ObjMesh> parse_obj(std::string_view text, const std::string& name) {
  constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
  if (text.substr(0, kUtf8Mark.size()) == kUtf8Mark) text.remove_prefix(kUtf8Mark.size());
  if (const std::size_t zero = text.find('\0'); zero != text.npos) {
    return InputError{name + ": a zero byte at byte " + std::to_string(zero) +
                      "; this is not a text file, so not an OBJ file"};
  }
  return ObjParser(text, name).parse();
}

InputResult<ObjMesh> read_obj(const std::string& path) {
  const auto text = read_whole_file(path);
  if (!text) return text.error();
  return parse_obj(*text, path);
}

}  // namespace rlpc
