#include "encoder/meshes/ply/ply_reader.h"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/meshes/input_file.h"
#include "encoder/meshes/mesh_text.h"
#include "encoder/meshes/ply/ply_attributes.h"
#include "encoder/meshes/ply/ply_body.h"
#include "encoder/meshes/ply/ply_header.h"

namespace rlpc {

namespace {

using std::to_string;

template <class Body>
class PlyReader {
 public:
  PlyReader(std::string_view text, const std::string& name, const PlyHeader& header,
            const MeshLimit& limit)
      : body_(text, header), name_(name), header_(header), limit_(limit) {}

  InputResult<SingleMesh> read() {
    mesh_.frame_rate = header_.frame_rate;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") num_vertices_ = element.count;
    }
    if (num_vertices_ == 0) return has_no_vertex();
    attributes_.find_roles(header_, limit_.with_attributes);
    if (limit_.with_attributes) {
      const std::string dropped = attributes_.without_role(header_);
      if (!dropped.empty()) mesh_.notes.push_back("dropped: " + dropped);
    }
    for (const PlyElement& element : header_.elements) {
      if (auto error = check(element)) return *error;
      read_element(element);
      if (auto error = failure()) return *error;
    }
    body_.expect_end();
    if (auto error = failure()) return *error;
    if (!cut_polygons(mesh_, limit_) || !attributes_.finish(mesh_, limit_)) {
      return too_large();
    }
    if (limit_.with_attributes) mesh_.materials.textures = header_.textures;
    return std::move(mesh_);
  }

 private:
  static bool is_scalar(const PlyElement& element, std::string_view name) {
    for (const PlyProperty& p : element.properties) {
      if (p.name == name) return !p.length;
    }
    return false;
  }

  InputError has_no_vertex() const {
    for (const PlyElement& element : header_.elements) {
      if (element.name != "vertex") continue;
      return {name_ +
              ": no vertices: an empty mesh; every frame needs the vertices and faces of the "
              "first"};
    }
    return {name_ + ": no vertices: the header needs an element \"vertex\""};
  }

  InputError too_large() const {
    return InputError{name_ + ": " + memory_problem(limit_.total_bytes)};
  }

  // Checks, before memory is allocated, that the counts of the header are possible and usable.
  std::optional<InputError> check(const PlyElement& element) const {
    std::uint64_t row_bytes = 0;
    for (const PlyProperty& p : element.properties) {
      row_bytes += Body::min_bytes(p.length.value_or(p.type));
    }
    // Cannot overflow: a count has 32 bits, and a row has only a few bytes per line of the
    // header.
    const std::uint64_t needed = row_bytes * element.count;
    if (needed > body_.bytes_left() + Body::spare_bytes()) {
      return InputError{name_ + ": element " + quoted(element.name) + ": " +
                        to_string(element.count) + " of them need at least " +
                        to_string(needed) + " bytes, but " + to_string(body_.bytes_left()) +
                        " are left in the file; is it complete?"};
    }
    if (element.name == "vertex") {
      const std::uint64_t floats = 3 + attributes_.floats_per_vertex();
      if (element.count * floats * sizeof(float) > limit_.mesh_bytes) return too_large();
      for (const char* axis : {"x", "y", "z"}) {
        if (is_scalar(element, axis)) continue;
        return InputError{name_ + ": element \"vertex\" has no number " + axis};
      }
    } else if (element.name == "face" && element.count > 0) {
      bool found = false;
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        found |= attributes_.face_roles()[i].kind == PlyRole::Kind::kPolygon &&
                 !is_ply_float(element.properties[i].type);
      }
      if (!found) {
        return InputError{name_ + ": element \"face\" has no list of integers vertex_indices"};
      }
    } else if (element.name == "tristrips") {
      return InputError{name_ + ": triangle strips are not supported; export triangles"};
    }
    return std::nullopt;
  }

  void read_element(const PlyElement& element) {
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element);
    for (std::uint32_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& p : element.properties) {
        skip(p);
        if (failed()) return;
      }
    }
  }

  void read_vertices(const PlyElement& element) {
    mesh_.xyz.resize(3 * std::size_t{element.count});
    attributes_.set_num_vertices(element.count);
    for (std::size_t v = 0; v < element.count; ++v) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyRole& role = attributes_.vertex_roles()[i];
        const PlyProperty& p = element.properties[i];
        if (role.kind == PlyRole::Kind::kSkipped) {
          skip(p);
        } else if (role.kind == PlyRole::Kind::kPosition) {
          mesh_.xyz[3 * v + role.component] = body_.coordinate(p.type);
          keep_left(3 * v + role.component);
        } else {
          attributes_.set_of_vertex(v, role, body_.coordinate(p.type));
        }
        if (failed()) return;
      }
    }
  }

  // Keeps the difference to a float; few files have numbers that floats cannot represent.
  void keep_left(std::size_t coordinate) {
    if (body_.left() == 0.0) return;
    if (mesh_.left.empty()) mesh_.left.resize(mesh_.xyz.size());
    mesh_.left[coordinate] = body_.left();
  }

  void read_faces(const PlyElement& element) {
    for (std::uint32_t f = 0; f < element.count; ++f) {
      const std::size_t first = mesh_.triangles.size();
      for (std::size_t i = 0; i < element.properties.size() && !failed(); ++i) {
        read_of_face(attributes_.face_roles()[i], element.properties[i]);
      }
      if (failed()) return;
      if (!limit_.add_face(mesh_, first)) {
        problem_ = memory_problem(limit_.total_bytes);
        return;
      }
      problem_ = attributes_.end_face(mesh_.triangles.size() - first, mesh_, limit_);
      if (failed()) return;
    }
  }

  void read_of_face(const PlyRole& role, const PlyProperty& p) {
    switch (role.kind) {
      case PlyRole::Kind::kPolygon:
        return read_polygon(p);
      case PlyRole::Kind::kCornerUv:
        return read_corner_uv(p);
      case PlyRole::Kind::kFaceColour:
        return attributes_.set_of_face(role, body_.coordinate(p.type));
      case PlyRole::Kind::kMaterial:
        return attributes_.set_material(body_.integer(p.type));
      default:
        return skip(p);
    }
  }

  void skip(const PlyProperty& p) { body_.skip(p.type, p.length ? length_of(p) : 1); }

  void read_corner_uv(const PlyProperty& list) {
    const std::uint64_t length = length_of(list);
    std::vector<float>& uv = attributes_.corner_uv();
    for (std::uint64_t i = 0; i < length; ++i) {
      const float value = body_.coordinate(list.type);
      if (failed()) return;
      if (!limit_.leaves_room(mesh_, uv)) {
        problem_ = memory_problem(limit_.total_bytes);
        return;
      }
      uv.push_back(value);
    }
  }

  std::uint64_t length_of(const PlyProperty& list) {
    const std::int64_t length = body_.integer(*list.length);
    if (length < 0) problem_ = "a list of " + to_string(length) + " values";
    return length < 0 ? 0 : static_cast<std::uint64_t>(length);
  }

  // Splits the polygon into a fan from its first corner.
  void read_polygon(const PlyProperty& list) {
    const std::uint64_t corners = length_of(list);
    if (!failed() && corners < 3) {
      problem_ = "a face of " + to_string(corners) + " corners; it needs 3 or more";
    }
    Triangle fan{};
    for (std::uint64_t i = 0; i < corners; ++i) {
      const std::uint32_t vertex = read_corner(list.type);
      if (failed()) return;
      if (i >= 3) fan[1] = fan[2];
      fan[i < 2 ? static_cast<std::size_t>(i) : 2] = vertex;
      if (i < 2) continue;
      if (!limit_.leaves_room(mesh_, mesh_.triangles)) {
        problem_ = memory_problem(limit_.total_bytes);
        return;
      }
      mesh_.triangles.push_back(fan);
    }
  }

  std::uint32_t read_corner(PlyType type) {
    const std::int64_t index = body_.integer(type);
    if (!failed() && (index < 0 || index >= num_vertices_)) {
      problem_ = "vertex index " + to_string(index) + " is out of range 0 to " +
                 to_string(num_vertices_ - 1);
    }
    return failed() ? 0 : static_cast<std::uint32_t>(index);
  }

  bool failed() const { return problem_ || body_.problem(); }
  std::optional<InputError> failure() const {
    if (!failed()) return std::nullopt;
    return InputError{name_ + body_.place() + ": " + (problem_ ? *problem_ : *body_.problem())};
  }

  Body body_;
  const std::string& name_;
  const PlyHeader& header_;
  const MeshLimit& limit_;
  std::int64_t num_vertices_ = 0;
  SingleMesh mesh_;
  PlyAttributes attributes_;
  std::optional<std::string> problem_;
};

}  // namespace

InputResult<SingleMesh> parse_ply(std::string_view text, const std::string& name,
                                  const MeshLimit& limit) {
  const auto header = parse_ply_header(text, name);
  if (!header) return header.error();
  if (header->encoding == PlyEncoding::kText) {
    return PlyReader<TextBody>(text, name, *header, limit).read();
  }
  return PlyReader<BinaryBody>(text, name, *header, limit).read();
}

namespace {

constexpr std::array<std::string_view, 1> kPlyExtensions{".ply"};

}  // namespace

const InputFormat kPlyFormat{
    .holds = InputFormat::Holds::kMesh,
    .extensions = kPlyExtensions,
    .begins =
        [](std::string_view beginning) {
          return beginning.starts_with("ply\n") || beginning.starts_with("ply\r");
        },
    .parse = parse_ply,
};

}  // namespace rlpc
