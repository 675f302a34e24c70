// Finds sets of texture coordinates that exporters wrote several times.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/primitive.h"

namespace rlpc {

// [number of a set]: number of the first set that is equal to it, or its own.
using EqualUv = std::vector<std::size_t>;

// Finds sets that are equal to an earlier one in each primitive that has them, and drops them
// there. Empty: no such sets.
EqualUv drop_equal_uv(std::vector<GltfGeometry>& geometries);

// Lets textures use the sets that are left.
void use_first_uv(const EqualUv& equal, nlohmann::json& materials);

// Returns a note for the user.
std::string equal_uv_note(const EqualUv& equal);

}  // namespace rlpc
