#include "encoder/meshes/gltf/equal_uv.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "encoder/meshes/glb_asset.h"

namespace rlpc {
namespace {

using Attribute = GltfGeometry::Attribute;

std::string semantic_of(std::size_t number) { return "TEXCOORD_" + std::to_string(number); }

const Attribute* find(const GltfGeometry& geometry, std::size_t number) {
  const auto found =
      std::find_if(geometry.attributes.begin(), geometry.attributes.end(),
                   [&](const Attribute& a) { return a.semantic == semantic_of(number); });
  return found == geometry.attributes.end() ? nullptr : &*found;
}

// Whether each geometry that has set `number` has the same values in the other one.
bool are_equal(const std::vector<GltfGeometry>& geometries, std::size_t number,
               std::size_t other) {
  return std::all_of(geometries.begin(), geometries.end(), [&](const GltfGeometry& geometry) {
    const Attribute* const set = find(geometry, number);
    const Attribute* const first = find(geometry, other);
    return set == nullptr || (first != nullptr && set->values == first->values);
  });
}

std::size_t num_sets(const std::vector<GltfGeometry>& geometries) {
  std::size_t count = 0;
  for (const GltfGeometry& geometry : geometries) {
    while (find(geometry, count) != nullptr) ++count;  // numbers have no gaps
  }
  return count;
}

// Replaces the number of the set that an object names.
void renumber(const EqualUv& equal, nlohmann::json& object) {
  const auto number = index_of(object, "texCoord", equal.size());
  if (number && *number != equal[*number]) object["texCoord"] = equal[*number];
}

}  // namespace

EqualUv drop_equal_uv(std::vector<GltfGeometry>& geometries) {
  EqualUv equal;
  const std::size_t count = num_sets(geometries);
  bool has_equal = false;
  for (std::size_t number = 0; number < count; ++number) {
    std::size_t first = 0;
    while (first < number && (equal[first] != first || !are_equal(geometries, number, first))) {
      ++first;
    }
    equal.push_back(first);
    has_equal |= first != number;
  }
  if (!has_equal) return {};
  for (GltfGeometry& geometry : geometries) {
    std::erase_if(geometry.attributes, [&](const Attribute& a) {
      for (std::size_t number = 0; number < count; ++number) {
        if (equal[number] != number && a.semantic == semantic_of(number)) return true;
      }
      return false;
    });
  }
  return equal;
}

void use_first_uv(const EqualUv& equal, nlohmann::json& materials) {
  if (equal.empty() || !materials.is_structured()) return;
  for (const auto& [name, member] : materials.items()) {
    if (materials.is_object() && name.ends_with("Texture") && member.is_object()) {
      renumber(equal, member);
      const auto extensions = member.find("extensions");
      if (extensions != member.end() && extensions->is_object() &&
          extensions->contains("KHR_texture_transform")) {
        renumber(equal, (*extensions)["KHR_texture_transform"]);
      }
    }
    use_first_uv(equal, member);
  }
}

std::string equal_uv_note(const EqualUv& equal) {
  std::string note;
  for (std::size_t number = 0; number < equal.size(); ++number) {
    if (equal[number] == number) continue;
    note += (note.empty() ? "" : ", ") + semantic_of(number) + " is equal to " +
            semantic_of(equal[number]);
  }
  return note + ": coded once";
}

}  // namespace rlpc
