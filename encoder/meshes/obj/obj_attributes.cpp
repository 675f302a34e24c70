#include "encoder/meshes/obj/obj_attributes.h"

#include <algorithm>
#include <utility>

#include "common/codec/attributes/attribute_names.h"
#include "encoder/meshes/mesh_attributes.h"

namespace rlpc {

namespace {

template <class T>
std::uint64_t bytes(const std::vector<T>& all) {
  return std::uint64_t{all.capacity()} * sizeof(T);
}

// Collector and mesh together.
struct Held {
  std::uint64_t all;
  std::uint64_t memory_bytes() const { return all; }
};

// Puts `value` at `place`, and `usual` at the missing places before; nothing as long as all are
// usual.
template <class T>
bool append(std::size_t place, const T& value, const T& usual, const MeshLimit& limit,
            const Held& held, std::vector<T>& list) {
  if (list.empty() && value == usual) return true;
  if (list.empty() && place > 0) {
    if (!limit.leaves_room_for(held, place * sizeof(T))) return false;
    list.resize(place, usual);
  }
  while (list.size() < place) {
    if (!limit.leaves_room(held, list)) return false;
    list.push_back(usual);
  }
  if (!limit.leaves_room(held, list)) return false;
  list.push_back(value);
  return true;
}

// Notes elements that get a value that is not in the file.
void note_gap(std::ptrdiff_t without, std::size_t all, const char* elements,
              const std::string& what, SingleMesh& mesh) {
  if (without == 0) return;
  mesh.notes.push_back(std::to_string(without) + " of " + std::to_string(all) + " " + elements +
                       " have no " + what);
}

std::vector<std::string> names_of(const std::map<std::string, std::uint32_t>& numbers) {
  std::vector<std::string> names(numbers.size());
  for (const auto& [name, number] : numbers) names[number] = name;
  return names;
}

}  // namespace

std::uint64_t ObjAttributes::memory_bytes() const {
  return bytes(uv_) + bytes(normals_) + bytes(colours_) + bytes(uv_of_) + bytes(normal_of_) +
         bytes(runs_) + name_bytes_;
}

bool ObjAttributes::add_colour(std::size_t vertex, const std::array<float, 3>& colour,
                               const MeshLimit& limit, std::uint64_t other_bytes) {
  for (std::size_t c = 0; c < 3; ++c) {
    const Held held{memory_bytes() + other_bytes};
    if (!append(3 * vertex + c, colour[c], -1.0F, limit, held, colours_)) return false;
  }
  return true;
}

bool ObjAttributes::add_triangle(std::size_t triangle, const std::array<ObjCorner, 3>& corners,
                                 const MeshLimit& limit, std::uint64_t other_bytes) {
  if (!part_) {
    const bool both = !object_.empty() && !group_.empty();
    part_ = number_of(object_ + (both ? "/" : "") + group_, parts_);
  }
  const Run run{triangle, material_.value_or(kNoValue), *part_};
  const bool is_new =
      runs_.empty() || runs_.back().material != run.material || runs_.back().part != run.part;
  const Held held{memory_bytes() + other_bytes};
  if (is_new) {
    if (!limit.leaves_room(held, runs_)) return false;
    runs_.push_back(run);
  }
  if (!limit.leaves_room_for(held, 0)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t c = 3 * triangle + k;
    if (!append(c, corners[k].uv, kNoValue, limit, held, uv_of_)) return false;
    if (!append(c, corners[k].normal, kNoValue, limit, held, normal_of_)) return false;
  }
  return true;
}

std::uint32_t ObjAttributes::number_of(const std::string& name, Numbers& numbers) {
  const auto next = static_cast<std::uint32_t>(numbers.size());
  const auto [place, is_new] = numbers.try_emplace(name, next);
  // Bytes of a node of the map, and of the list of names.
  constexpr std::uint64_t kBytes = 160;
  if (is_new) name_bytes_ += kBytes + 2 * name.size();
  return place->second;
}

void ObjAttributes::set_object(std::string name) {
  object_ = std::move(name);
  part_.reset();
}

void ObjAttributes::set_group(std::string name) {
  group_ = std::move(name);
  part_.reset();
}

std::vector<std::uint32_t> ObjAttributes::numbers_of(std::uint32_t Run::*what,
                                                     std::uint32_t if_none,
                                                     std::size_t num_triangles) const {
  std::vector<std::uint32_t> numbers(num_triangles);
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t end = r + 1 < runs_.size() ? runs_[r + 1].first_triangle : num_triangles;
    const std::uint32_t number = runs_[r].*what;
    std::fill(numbers.begin() + static_cast<std::ptrdiff_t>(runs_[r].first_triangle),
              numbers.begin() + static_cast<std::ptrdiff_t>(end),
              number == kNoValue ? if_none : number);
  }
  return numbers;
}

bool ObjAttributes::finish(SingleMesh& mesh, const MeshLimit& limit) {
  // Needed at most: a normal of each triangle, numbers of materials and parts, lists that grow
  // by their last values.
  const std::size_t num_triangles = mesh.triangles.size();
  const bool has_runs = runs_.size() > 1;
  const std::uint64_t more = (has_runs ? 4 * sizeof(std::uint32_t) * num_triangles : 0) +
                             (normal_of_.empty() ? 0 : 3 * sizeof(float) * num_triangles) +
                             bytes(uv_) + bytes(normals_);
  if (!limit.leaves_room_for(Held{mesh.memory_bytes() + memory_bytes()}, more)) return false;
  const auto cut = [&](std::vector<std::uint32_t>& value_of_corner) {
    value_of_corner.resize(3 * num_triangles, kNoValue);
    mesh.cuts.apply(value_of_corner);
  };
  std::vector<SourceAttribute>& sets = mesh.attributes.sets;
  if (!colours_.empty()) {
    colours_.resize(mesh.xyz.size(), -1.0F);
    const auto without = std::count(colours_.begin(), colours_.end(), -1.0F) / 3;
    std::replace(colours_.begin(), colours_.end(), -1.0F, 1.0F);
    if (are_colours(colours_)) {
      note_gap(without, colours_.size() / 3, "vertices", "colour: they become white", mesh);
      sets.push_back(colour_attribute(std::move(colours_), 3, false, {}));
    } else {
      mesh.notes.emplace_back(
          "dropped: numbers after vertices that are no colours from 0 to 1");
    }
  }
  // Indices without any value are ignored.
  if (!normals_.empty() && !normal_of_.empty()) {
    cut(normal_of_);
    sets.push_back(
        normal_attribute(std::move(normals_), std::move(normal_of_), mesh.xyz, mesh.triangles));
  }
  if (!uv_.empty() && !uv_of_.empty()) {
    cut(uv_of_);
    note_gap(std::count(uv_of_.begin(), uv_of_.end(), kNoValue), uv_of_.size(), "corners",
             "texture coordinates: they get 0 0", mesh);
    sets.push_back(uv_attribute(std::move(uv_), std::move(uv_of_)));
  }
  mesh.materials.names = names_of(materials_);
  const bool has_parts = parts_.size() > 1 || !parts_.contains("");
  if (has_parts) mesh.materials.part_names = names_of(parts_);
  if (!has_runs) return true;
  const auto num_materials = static_cast<std::uint32_t>(materials_.size());
  const auto add = [&](const char* name, std::uint32_t Run::*what) {
    const auto numbers = numbers_of(what, num_materials, num_triangles);
    if (auto set = triangle_attribute(name, numbers)) sets.push_back(std::move(*set));
  };
  add(kMaterialName, &Run::material);
  add(kPartName, &Run::part);
  return true;
}

}  // namespace rlpc
