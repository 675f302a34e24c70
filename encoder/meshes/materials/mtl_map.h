// References to images in .mtl files.
#pragma once

#include <array>
#include <string>

#include "encoder/meshes/mesh_text.h"

namespace rlpc {

// Argument of map_Kd and others: "-s 2 2 1 -o 0.1 0 skin tone.png".
struct MtlMap {
  std::string name{};                      // may have blanks; empty: no image
  std::array<double, 2> scale{1.0, 1.0};   // -s: of texture coordinates, before the offset
  std::array<double, 2> offset{0.0, 0.0};  // -o
};

// Reads the rest of a line. Other options are passed over.
MtlMap read_mtl_map(TextWords& words);

}  // namespace rlpc
