#include "encoder/meshes/ply/ply_attributes.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "common/codec/attributes/attribute_names.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/mesh_attributes.h"
#include "encoder/meshes/mesh_text.h"

namespace rlpc {

namespace {

using Kind = PlyRole::Kind;
using Names = std::initializer_list<std::string_view>;

struct Held {
  std::uint64_t all;
  std::uint64_t memory_bytes() const { return all; }
};

template <class T>
std::uint64_t bytes(const std::vector<T>& all) {
  return std::uint64_t{all.capacity()} * sizeof(T);
}

// Returns the number that means 1, if a property may hold a component of a colour.
std::optional<float> colour_unit(const PlyProperty& p) {
  if (is_ply_float(p.type)) return 1.0F;
  if (p.type == PlyType::kU8) return 255.0F;
  if (p.type == PlyType::kU16) return 65535.0F;
  return std::nullopt;
}

std::optional<std::size_t> index_of(const PlyElement& element, std::string_view name) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].name == name && !element.properties[i].length) return i;
  }
  return std::nullopt;
}

// Gives the properties of these names a role if all of them exist.
bool claim(const PlyElement& element, Names names, Kind kind, std::vector<PlyRole>& roles) {
  const bool is_colour = kind == Kind::kColour || kind == Kind::kFaceColour;
  for (const std::string_view name : names) {
    const auto i = index_of(element, name);
    if (!i || (is_colour && !colour_unit(element.properties[*i]))) return false;
  }
  std::size_t component = 0;
  for (const std::string_view name : names) {
    const std::size_t i = *index_of(element, name);
    roles[i] = {kind, component++, 1.0F};
    if (is_colour) roles[i].unit = *colour_unit(element.properties[i]);
  }
  return true;
}

std::size_t claim_colours(const PlyElement& element, Kind kind, std::vector<PlyRole>& roles) {
  if (claim(element, {"red", "green", "blue", "alpha"}, kind, roles)) return 4;
  return claim(element, {"red", "green", "blue"}, kind, roles) ? 3 : 0;
}

bool are_all_bytes(const PlyElement& element, Kind kind, const std::vector<PlyRole>& roles) {
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i].kind == kind && element.properties[i].type != PlyType::kU8) return false;
  }
  return true;
}

}  // namespace

void PlyAttributes::find_roles(const PlyHeader& header, bool with_attributes) {
  for (const PlyElement& element : header.elements) {
    if (element.name != "vertex") continue;
    vertex_roles_.assign(element.properties.size(), {});
    claim(element, {"x", "y", "z"}, Kind::kPosition, vertex_roles_);
    if (!with_attributes) continue;
    claim(element, {"nx", "ny", "nz"}, Kind::kNormal, vertex_roles_);
    for (const Names& names : {Names{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
      if (claim(element, names, Kind::kUv, vertex_roles_)) break;
    }
    colour_width_ = claim_colours(element, Kind::kColour, vertex_roles_);
    are_bytes_ = are_all_bytes(element, Kind::kColour, vertex_roles_);
  }
  for (const PlyElement& element : header.elements) {
    if (element.name != "face") continue;
    face_roles_.assign(element.properties.size(), {});
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& p = element.properties[i];
      if (!p.length) continue;
      if (p.name == "vertex_indices" || p.name == "vertex_index") {
        face_roles_[i].kind = Kind::kPolygon;
      } else if (p.name == "texcoord" && with_attributes) {
        face_roles_[i].kind = Kind::kCornerUv;
        has_corner_uv_ = true;
      }
    }
    if (!with_attributes) continue;
    for (const char* const name : {"material_index", "texnumber"}) {
      const auto i = index_of(element, name);
      if (has_materials_ || !i || is_ply_float(element.properties[*i].type)) continue;
      face_roles_[*i].kind = Kind::kMaterial;
      has_materials_ = true;
    }
    if (colour_width_ > 0) {
      continue;
    }
    face_colour_width_ = claim_colours(element, Kind::kFaceColour, face_roles_);
    are_bytes_ = are_all_bytes(element, Kind::kFaceColour, face_roles_);
  }
  if (!has_corner_uv_) return;
  for (PlyRole& role : vertex_roles_) {
    if (role.kind == Kind::kUv) role.kind = Kind::kSkipped;
  }
}

std::string PlyAttributes::without_role(const PlyHeader& header) const {
  std::string list;
  const auto add = [&](const std::string& what) { list += (list.empty() ? "" : ", ") + what; };
  for (const PlyElement& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    if (element.count == 0) continue;
    if (!is_vertex && element.name != "face") {
      add("element " + quoted(element.name) + " (" + std::to_string(element.count) + ")");
      continue;
    }
    const std::vector<PlyRole>& roles = is_vertex ? vertex_roles_ : face_roles_;
    std::string names;
    for (std::size_t i = 0; i < roles.size(); ++i) {
      const std::string& name = element.properties[i].name;
      if (roles[i].kind != Kind::kSkipped) continue;
      names += (names.empty() ? "" : ", ") + quoted(name);
    }
    if (!names.empty()) add(names + (is_vertex ? " of vertices" : " of faces"));
  }
  if (header.has_info) add("obj_info");
  return list;
}

std::size_t PlyAttributes::floats_per_vertex() const {
  return static_cast<std::size_t>(
      std::count_if(vertex_roles_.begin(), vertex_roles_.end(), [](const PlyRole& role) {
        return role.kind == Kind::kNormal || role.kind == Kind::kUv ||
               role.kind == Kind::kColour;
      }));
}

void PlyAttributes::set_num_vertices(std::size_t count) {
  for (const PlyRole& role : vertex_roles_) {
    if (role.kind == Kind::kNormal) normals_.resize(3 * count);
    if (role.kind == Kind::kUv) uv_.resize(2 * count);
    if (role.kind == Kind::kColour) colours_.resize(colour_width_ * count);
  }
}

void PlyAttributes::set_of_vertex(std::size_t vertex, const PlyRole& role, float value) {
  if (role.kind == Kind::kNormal) normals_[3 * vertex + role.component] = value;
  if (role.kind == Kind::kUv) uv_[2 * vertex + role.component] = value;
  if (role.kind == Kind::kColour) {
    colours_[colour_width_ * vertex + role.component] = value / role.unit;
  }
}

void PlyAttributes::set_of_face(const PlyRole& role, float value) {
  face_colour_[role.component] = value / role.unit;
}

std::uint64_t PlyAttributes::memory_bytes() const {
  return bytes(normals_) + bytes(uv_) + bytes(colours_) + bytes(uv_of_) + bytes(colour_of_) +
         bytes(materials_);
}

std::optional<std::string> PlyAttributes::end_face(std::size_t num_triangles,
                                                   const SingleMesh& mesh,
                                                   const MeshLimit& limit) {
  const std::size_t corners = num_triangles + 2;
  bool has_room = true;
  const auto push = [&](auto& list, auto value) {
    has_room = has_room && limit.leaves_room(Held{mesh.memory_bytes() + memory_bytes()}, list);
    if (has_room) list.push_back(value);
  };
  if (has_corner_uv_) {
    if (face_uv_.size() != 2 * corners) {
      has_bad_uv_ = has_bad_uv_ || !face_uv_.empty();
      face_uv_.clear();
    }
    const auto first = static_cast<std::uint32_t>(uv_.size() / 2);
    for (const float value : face_uv_) push(uv_, value);
    for (std::size_t t = 0; t < num_triangles; ++t) {
      for (const std::size_t corner : {std::size_t{0}, t + 1, t + 2}) {
        push(uv_of_, face_uv_.empty() ? kNoValue : first + static_cast<std::uint32_t>(corner));
      }
    }
    face_uv_.clear();
  }
  if (face_colour_width_ > 0) {
    const auto face = static_cast<std::uint32_t>(colours_.size() / face_colour_width_);
    for (std::size_t c = 0; c < face_colour_width_; ++c) push(colours_, face_colour_[c]);
    for (std::size_t c = 0; c < 3 * num_triangles; ++c) push(colour_of_, face);
  }
  if (has_materials_) {
    are_materials_bad_ = are_materials_bad_ || material_ < 0 || material_ > 65535;
    for (std::size_t t = 0; t < num_triangles; ++t) {
      push(materials_, static_cast<std::uint32_t>(material_));
    }
  }
  if (!has_room) return memory_problem(limit.total_bytes);
  return std::nullopt;
}

bool PlyAttributes::finish(SingleMesh& mesh, const MeshLimit& limit) {
  // Lists that grow by their last values, and materials as floats.
  const std::uint64_t more = bytes(uv_) + bytes(materials_);
  if (!limit.leaves_room_for(Held{mesh.memory_bytes() + memory_bytes()}, more)) return false;
  mesh.cuts.apply(uv_of_);
  std::vector<SourceAttribute>& sets = mesh.attributes.sets;
  const std::size_t width = std::max(colour_width_, face_colour_width_);
  if (!colours_.empty() && !are_colours(colours_)) {
    mesh.notes.emplace_back("dropped: colours outside 0 to 1");
  } else if (!colours_.empty()) {
    sets.push_back(colour_attribute(std::move(colours_), static_cast<std::uint32_t>(width),
                                    are_bytes_, std::move(colour_of_)));
  }
  if (!normals_.empty()) {
    sets.push_back(normal_attribute(std::move(normals_), {}, mesh.xyz, mesh.triangles));
  }
  if (has_bad_uv_) {
    mesh.notes.emplace_back("dropped: lists texcoord without two values for each corner");
  }
  if (!uv_.empty()) sets.push_back(uv_attribute(std::move(uv_), std::move(uv_of_)));
  if (are_materials_bad_) {
    mesh.notes.emplace_back("dropped: numbers of materials, some of which are not 0 to 65535");
  } else if (has_materials_) {
    if (auto set = triangle_attribute(kMaterialName, materials_))
      sets.push_back(std::move(*set));
  }
  return true;
}

}  // namespace rlpc
