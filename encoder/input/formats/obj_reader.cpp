#include "encoder/input/formats/obj_reader.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

#include "encoder/input/formats/mesh_text.h"
#include "encoder/input/input_file.h"

namespace rlpc {

namespace {

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name, const MeshLimit& limit)
      : words_(text), name_(name), limit_(limit) {}

  InputResult<SingleMesh> parse() {
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

  void fail_for_memory() { fail(words_.line(), memory_problem(limit_.of_all)); }

  std::string out_of_range(std::int64_t index) const {
    return "vertex index " + std::to_string(index) + " is out of range 1 to " +
           std::to_string(num_vertices()) + "; is the file complete?";
  }

  // Reads "v x y z" and ignores the rest of the line.
  void read_vertex() {
    if (num_vertices() == std::numeric_limits<std::uint32_t>::max()) {
      return fail(words_.line(), "more than 2^32 - 1 vertices");
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (!limit_.leaves_room(mesh_, mesh_.xyz)) return fail_for_memory();
      mesh_.xyz.push_back(read_float());
    }
  }

  float read_float() {
    const std::string_view word = words_.next();
    if (word.empty()) {
      fail(words_.line(), "a vertex needs three coordinates");
      return 0;
    }
    std::optional<std::string> problem;
    const float value = parse_coordinate(word, problem);
    if (problem) fail(words_.line(), *problem);
    return value;
  }

  // Reads "f a b c ..." as a fan from the first corner.
  void read_face() {
    Triangle fan{};
    std::size_t corners = 0;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      const std::uint32_t vertex = parse_corner(word);
      if (error_) return;
      if (corners >= 3) fan[1] = fan[2];
      fan[corners < 2 ? corners : 2] = vertex;
      ++corners;
      if (corners < 3) continue;
      if (!limit_.leaves_room(mesh_, mesh_.triangles)) return fail_for_memory();
      mesh_.triangles.push_back(fan);
    }
    if (corners < 3) {
      fail(words_.line(),
           "a face of " + std::to_string(corners) + " corners; it needs 3 or more");
    }
  }

  // Parses v, v/vt, v//vn or v/vt/vn; v counts from 1, or backwards from the last vertex, -1.
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

  // The zero-based index. Vertices may follow: indices beyond them are checked at the end of
  // the file.
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

  TextWords words_;
  const std::string& name_;
  const MeshLimit& limit_;
  SingleMesh mesh_;
  std::optional<InputError> error_;
  std::int64_t highest_index_ = 0;
  std::uint64_t highest_line_ = 0;
};

}  // namespace

InputResult<SingleMesh> parse_obj(std::string_view text, const std::string& name,
                                  const MeshLimit& limit) {
  constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
  if (text.substr(0, kUtf8Mark.size()) == kUtf8Mark) text.remove_prefix(kUtf8Mark.size());
  if (const std::size_t zero = text.find('\0'); zero != text.npos) {
    return InputError{name + ": a zero byte at byte " + std::to_string(zero) +
                      "; this is not a text file, so not an OBJ file"};
  }
  return ObjParser(text, name, limit).parse();
}

namespace {

constexpr std::array<std::string_view, 1> kObjExtensions{".obj"};

}  // namespace

const InputFormat kObjFormat{
    .holds = InputFormat::Holds::kMesh,
    .extensions = kObjExtensions,
    .begins =
        [](std::string_view beginning) {
          const std::string_view text = after_blanks(beginning);
          return text.starts_with("#") || text.starts_with("v ") || text.starts_with("o ");
        },
    .parse = parse_obj,
};

}  // namespace rlpc
