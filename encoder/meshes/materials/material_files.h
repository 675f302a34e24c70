// Reads the .mtl files that OBJ files name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/meshes/mesh_reader.h"

namespace rlpc {

// Reads a mesh, and the .mtl files and images that it names if they are in its folder or below
// it, into its asset. images: what becomes of them. Notes: files that cannot be read;
// properties of materials that the stream does not hold.
InputResult<SingleMesh> read_mesh_and_materials(const std::string& path, Images images,
                                                std::uint64_t max_memory_bytes);

// Reads the .mtl files that a mesh names into its materials, and adds notes about those that
// cannot be read.
void read_material_text(const std::string& path, std::uint64_t max_memory_bytes,
                        SingleMesh& mesh);

// Whether a name leads to a place in or below the folder, even if it is a link.
bool stays_below(const std::filesystem::path& folder, const std::filesystem::path& name);

// Returns the image files that an .mtl file names, each once, in order.
std::vector<std::string> textures_of(std::string_view mtl);

}  // namespace rlpc
