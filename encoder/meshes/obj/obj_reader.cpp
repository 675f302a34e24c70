#include "encoder/meshes/obj/obj_reader.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "encoder/meshes/input_file.h"
#include "encoder/meshes/mesh_attributes.h"
#include "encoder/meshes/mesh_text.h"
#include "encoder/meshes/obj/obj_attributes.h"
#include "encoder/meshes/obj/obj_rest.h"

namespace rlpc {

namespace {

// A list that corners of faces refer to by number.
struct Indexed {
  const char* name;
  // The largest index so far of one that has not been read yet, and its line.
  std::int64_t highest = 0;
  std::uint64_t highest_line = 0;
};

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
      } else if (limit_.with_attributes) {
        read_attribute(keyword);
      } else {
        rest_.add_line(keyword, "");
      }
      if (error_) return *error_;
    }
    if (mesh_.xyz.empty()) return has_no_vertex();
    check_highest(vertices_, num_vertices());
    if (!error_ && !cut_polygons(mesh_, limit_)) fail_for_memory();
    if (limit_.with_attributes) {
      check_or_ignore(uv_, attributes_.num_uv());
      check_or_ignore(normals_, attributes_.num_normals());
      if (!error_ && !attributes_.finish(mesh_, limit_)) fail_for_memory();
      if (auto note = rest_.note()) mesh_.notes.push_back(std::move(*note));
    }
    if (error_) return *error_;
    return std::move(mesh_);
  }

  std::uint64_t memory_bytes() const {
    return mesh_.memory_bytes() + attributes_.memory_bytes();
  }

 private:
  std::int64_t num_vertices() const { return static_cast<std::int64_t>(mesh_.xyz.size() / 3); }

  void fail(std::uint64_t line, const std::string& what) {
    if (!error_) error_ = InputError{name_ + ":" + std::to_string(line) + ": " + what};
  }

  InputError has_no_vertex() const {
    return {name_ + (rest_.num_unknown_lines() > 0
                         ? ": no vertex (no line \"v x y z\"); is this an OBJ file?"
                         : ": no vertex: an empty mesh; every frame needs the vertices and "
                           "faces of the first")};
  }

  void fail_for_memory() { fail(words_.line(), memory_problem(limit_.total_bytes)); }

  static std::string out_of_range(const Indexed& kind, std::int64_t index, std::int64_t count) {
    return kind.name + std::string(" index ") + std::to_string(index) +
           " is out of range 1 to " + std::to_string(count) + "; is the file complete?";
  }

  void check_highest(const Indexed& kind, std::int64_t count) {
    if (kind.highest > count) fail(kind.highest_line, out_of_range(kind, kind.highest, count));
  }

  // Checks indices; ignores those of lists that the file does not have, as some files do.
  void check_or_ignore(const Indexed& kind, std::int64_t count) {
    if (count > 0) return check_highest(kind, count);
    if (kind.highest == 0) return;
    mesh_.notes.push_back(std::string("ignores each ") + kind.name +
                          " index, as the file has none of these");
  }

  template <class T>
  void push(T value, std::vector<T>& list) {
    if (!limit_.leaves_room(*this, list)) return fail_for_memory();
    list.push_back(value);
  }

  // Keeps the difference of the last coordinate from its float, where there is one.
  void keep_left(double left) {
    if (left == 0.0) return;
    while (!error_ && mesh_.left.size() + 1 < mesh_.xyz.size()) push(0.0, mesh_.left);
    if (!error_) push(left, mesh_.left);
  }

  // Reads "v x y z" or "v x y z r g b", and notes other contents of the line.
  void read_vertex() {
    if (num_vertices() == std::numeric_limits<std::uint32_t>::max()) {
      return fail(words_.line(), "more than 2^32 - 1 vertices");
    }
    for (int axis = 0; axis < 3 && !error_; ++axis) {
      double left = 0.0;
      push(read_float("a vertex needs three coordinates", &left), mesh_.xyz);
      keep_left(left);
    }
    if (!error_ && limit_.with_attributes) read_rest_of_vertex();
  }

  void read_rest_of_vertex() {
    std::array<float, 3> colour{};
    std::size_t count = 0;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      std::optional<std::string> problem;
      const float value = parse_coordinate(word, problem);
      if (problem || count == colour.size()) return rest_.add_vertex_numbers();
      colour[count++] = value;
    }
    if (count == 1 && colour[0] != 1.0F) rest_.add_weight();
    if (count == 2) rest_.add_vertex_numbers();
    if (count < colour.size()) return;
    const auto vertex = static_cast<std::size_t>(num_vertices() - 1);
    if (!attributes_.add_colour(vertex, colour, limit_, mesh_.memory_bytes())) {
      fail_for_memory();
    }
  }

  float read_float(const char* if_none, double* left = nullptr) {
    const std::string_view word = words_.next();
    if (word.empty()) {
      fail(words_.line(), if_none);
      return 0;
    }
    std::optional<std::string> problem;
    const float value = parse_coordinate(word, problem, left);
    if (problem) fail(words_.line(), *problem);
    return value;
  }

  void read_attribute(std::string_view keyword) {
    if (keyword == "vt") {
      push(read_float("a texture coordinate needs one number or more"), attributes_.uv());
      const std::string_view word = words_.next();
      std::optional<std::string> problem;
      push(word.empty() ? 0.0F : parse_coordinate(word, problem), attributes_.uv());
      if (problem) fail(words_.line(), *problem);
      if (parse_number(words_.next()).value_or(0.0) != 0.0) rest_.add_third_uv();
    } else if (keyword == "vn") {
      for (int axis = 0; axis < 3 && !error_; ++axis) {
        push(read_float("a normal needs three coordinates"), attributes_.normals());
      }
    } else if (keyword == "usemtl") {
      attributes_.set_material(words_.rest_of_words());
    } else if (keyword == "o") {
      attributes_.set_object(words_.rest_of_words());
    } else if (keyword == "g") {
      attributes_.set_group(words_.rest_of_words());
    } else if (keyword == "mtllib") {
      if (!mesh_.material_library.empty()) mesh_.material_library += '\n';
      mesh_.material_library += words_.rest_of_words();
    } else {
      rest_.add_line(keyword, words_.next());
    }
    if (!limit_.leaves_room_for(*this, 0)) fail_for_memory();
  }

  // Reads "f a b c ..." as a fan from the first corner.
  void read_face() {
    const std::size_t first_triangle = mesh_.triangles.size();
    std::array<ObjCorner, 3> fan{};
    std::size_t corners = 0;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      const ObjCorner corner = parse_corner(word);
      if (error_) return;
      if (corners >= 3) fan[1] = fan[2];
      fan[corners < 2 ? corners : 2] = corner;
      ++corners;
      if (corners >= 3) add_triangle(fan);
    }
    if (corners < 3) {
      fail(words_.line(),
           "a face of " + std::to_string(corners) + " corners; it needs 3 or more");
    }
    if (!limit_.add_face(mesh_, first_triangle)) fail_for_memory();
  }

  void add_triangle(const std::array<ObjCorner, 3>& corners) {
    if (!limit_.leaves_room(*this, mesh_.triangles)) return fail_for_memory();
    const std::size_t triangle = mesh_.triangles.size();
    mesh_.triangles.push_back({corners[0].vertex, corners[1].vertex, corners[2].vertex});
    if (limit_.with_attributes &&
        !attributes_.add_triangle(triangle, corners, limit_, mesh_.memory_bytes())) {
      fail_for_memory();
    }
  }

  // Parses v, v/vt, v//vn or v/vt/vn; each counts from 1, or backwards from the last, -1.
  ObjCorner parse_corner(std::string_view word) {
    const char* const last = word.data() + word.size();
    std::array<std::int64_t, 3> index{};
    std::array<bool, 3> is_there{};
    const char* at = word.data();
    bool ok = true;
    for (std::size_t part = 0; part < 3 && ok; ++part) {
      if (part > 0 && (at == last || *at != '/')) break;
      if (part > 0) ++at;
      if (part == 1 && at != last && *at == '/') continue;
      const auto [end, ec] = std::from_chars(at, last, index[part]);
      ok = ec == std::errc();
      is_there[part] = ok;
      at = end;
    }
    if (!ok || at != last) {
      fail(words_.line(),
           quoted(word) + " is not a face corner; expected v, v/vt, v//vn or v/vt/vn");
      return {};
    }
    const auto resolved = [&](std::size_t part, Indexed& kind, std::int64_t count) {
      if (!is_there[part] || !limit_.with_attributes) return kNoValue;
      return resolve(index[part], kind, count);
    };
    return {resolve(index[0], vertices_, num_vertices()),
            resolved(1, uv_, attributes_.num_uv()),
            resolved(2, normals_, attributes_.num_normals())};
  }

  // Returns the zero-based index. Its element may follow: indices beyond the list are checked
  // at the end of the file.
  std::uint32_t resolve(std::int64_t index, Indexed& kind, std::int64_t count) {
    const std::string name = kind.name;
    if (index == 0) fail(words_.line(), name + " index 0; counting starts at 1");
    if (index > std::numeric_limits<std::uint32_t>::max() || index < -count) {
      fail(words_.line(), index > 0 ? out_of_range(kind, index, count)
                                    : name + " index " + std::to_string(index) + ", but only " +
                                          std::to_string(count) + " come before it");
    }
    if (index > count && index > kind.highest) {
      kind.highest = index;
      kind.highest_line = words_.line();
    }
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
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
  ObjAttributes attributes_;
  std::optional<InputError> error_;
  ObjRest rest_;
  Indexed vertices_{"vertex"};
  Indexed uv_{"texture coordinate"};
  Indexed normals_{"normal"};
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
