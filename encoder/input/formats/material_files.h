// The .mtl files beside OBJ files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/input/mesh_reader.h"

namespace rlpc {

// Reads a mesh, and the .mtl files that it names if they are in its folder or below it. Notes:
// files that cannot be read; what is known of materials but not part of the stream.
InputResult<SingleMesh> read_mesh_and_materials(const std::string& path,
                                                std::uint64_t max_memory_bytes);

// Image files that an .mtl file names, each once, in order.
std::vector<std::string> textures_of(std::string_view mtl);

}  // namespace rlpc
