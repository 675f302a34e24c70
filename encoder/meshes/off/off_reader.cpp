#include "encoder/meshes/off/off_reader.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

#include "encoder/meshes/input_file.h"
#include "encoder/meshes/mesh_text.h"

namespace rlpc {

namespace {

using std::to_string;

class OffParser {
 public:
  OffParser(std::string_view text, const std::string& name, const MeshLimit& limit)
      : words_(text), bytes_(text.size()), name_(name), limit_(limit) {}

  InputResult<SingleMesh> parse() {
    check_keyword(words_.next_of_any_line());
    const std::uint32_t vertices = read_number("the number of vertices");
    const std::uint32_t faces = read_number("the number of faces");
    if (vertices == 0) {
      fail("no vertices: an empty mesh; every frame needs the vertices and faces of the first");
    }
    // The third number of the line, the number of edges, is ignored. A vertex takes at least 6
    // bytes, "0 0 0" and a line end; a face, "3 0 0 0", takes more.
    if ((std::uint64_t{vertices} + faces) * 6 > std::uint64_t{bytes_} + 1) {
      fail(to_string(vertices) + " vertices and " + to_string(faces) +
           " faces do not fit the " + to_string(bytes_) +
           " bytes of the file; is it complete?");
    }
    for (std::uint32_t v = 0; v < vertices && !error_; ++v) read_vertex();
    for (std::uint32_t f = 0; f < faces && !error_; ++f) read_face(vertices);
    if (!error_) {
      words_.next_line();
      if (!words_.next_of_any_line().empty()) fail("has data after the last face");
    }
    note_what_is_dropped();
    if (!error_ && !cut_polygons(mesh_, limit_)) fail(memory_problem(limit_.total_bytes));
    if (error_) return *error_;
    return std::move(mesh_);
  }

 private:
  void fail(const std::string& what) {
    if (!error_) error_ = InputError{name_ + ":" + to_string(words_.line()) + ": " + what};
  }

  void check_keyword(std::string_view keyword) {
    if (!looks_like_off(keyword)) return fail("does not begin with OFF; not an OFF file");
    if (keyword.find_first_of("4n") != keyword.npos) {
      fail(quoted(keyword) + ": only vertices in three dimensions are supported");
    }
  }

  void note_what_is_dropped() {
    std::string list;
    if (extra_of_vertices_) list += "numbers after the positions of vertices";
    if (extra_of_faces_) list += std::string(list.empty() ? "" : ", ") + "colours of faces";
    if (!list.empty() && limit_.with_attributes) mesh_.notes.push_back("dropped: " + list);
  }

  // Reads a count of the header, or the number of corners of a face.
  std::uint32_t read_number(const std::string& what) {
    return parse_number(words_.next_of_any_line(), what);
  }

  std::uint32_t parse_number(std::string_view word, const std::string& what) {
    std::uint32_t value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, ec] = std::from_chars(word.data(), last, value);
    if (ec == std::errc() && end == last) return value;
    if (word == "BINARY") {
      fail("binary OFF files are not supported; save it as text, or as PLY");
    } else if (words_.at_end()) {
      fail("the file ends before " + what + "; is it complete?");
    } else {
      fail(quoted(word) + ": expected " + what + ", from 0 to 4294967295");
    }
    return 0;
  }

  // Reads "x y z" and drops the rest of the line; skips blank lines and comments.
  void read_vertex() {
    words_.next_line();
    std::string_view word = words_.next_of_any_line();
    for (int axis = 0; axis < 3 && !error_; ++axis) {
      std::optional<std::string> problem;
      if (word.empty()) {
        problem = words_.at_end() ? "the file ends before the last vertex; is it complete?"
                                  : "a vertex needs three coordinates";
      } else if (!limit_.leaves_room(mesh_, mesh_.xyz)) {
        problem = memory_problem(limit_.total_bytes);
      } else {
        mesh_.left.push_back(0.0);
        mesh_.xyz.push_back(parse_coordinate(word, problem, &mesh_.left.back()));
      }
      if (problem) fail(*problem);
      if (axis < 2) word = words_.next();
    }
    extra_of_vertices_ |= !words_.next().empty();
  }

  // Reads "n a b c ..." as a fan from the first corner, and drops the rest of the line.
  void read_face(std::uint32_t vertices) {
    words_.next_line();
    const std::uint32_t corners = read_number("the number of corners of a face");
    if (corners < 3) fail("a face of " + to_string(corners) + " corners; it needs 3 or more");
    const std::size_t first_triangle = mesh_.triangles.size();
    Triangle fan{};
    for (std::uint32_t i = 0; i < corners && !error_; ++i) {
      const std::uint32_t vertex = parse_number(words_.next(), "a vertex index");
      if (vertex >= vertices) {
        fail("vertex index " + to_string(vertex) + " is out of range 0 to " +
             to_string(vertices - 1));
      }
      if (i >= 3) fan[1] = fan[2];
      fan[i < 2 ? i : 2] = vertex;
      if (i < 2) continue;
      if (!limit_.leaves_room(mesh_, mesh_.triangles)) {
        return fail(memory_problem(limit_.total_bytes));
      }
      mesh_.triangles.push_back(fan);
    }
    extra_of_faces_ |= !words_.next().empty();
    if (!limit_.add_face(mesh_, first_triangle)) fail(memory_problem(limit_.total_bytes));
  }

  TextWords words_;
  std::size_t bytes_;
  const std::string& name_;
  const MeshLimit& limit_;
  SingleMesh mesh_;
  bool extra_of_vertices_ = false;  // numbers after those that are read
  bool extra_of_faces_ = false;
  std::optional<InputError> error_;
};

}  // namespace

bool looks_like_off(std::string_view text) {
  if (text.starts_with("ST")) text.remove_prefix(2);
  for (const char letter : {'C', 'N', '4', 'n'}) {
    if (text.starts_with(letter)) text.remove_prefix(1);
  }
  if (!text.starts_with("OFF")) return false;
  return text.size() == 3 || text.find_first_of(" \t\r\n#") == 3;
}

InputResult<SingleMesh> parse_off(std::string_view text, const std::string& name,
                                  const MeshLimit& limit) {
  return OffParser(text, name, limit).parse();
}

namespace {

constexpr std::array<std::string_view, 1> kOffExtensions{".off"};

}  // namespace

const InputFormat kOffFormat{
    .holds = InputFormat::Holds::kMesh,
    .extensions = kOffExtensions,
    .begins =
        [](std::string_view beginning) { return looks_like_off(after_blanks(beginning)); },
    .parse = parse_off,
};

}  // namespace rlpc
