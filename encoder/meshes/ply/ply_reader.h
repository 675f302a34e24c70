// PLY: the positions and polygons of the elements "vertex" and "face", and their attributes
// (ply_attributes.h); everything else is skipped. Text and binary of both byte orders.
//
// It is as strict as the OBJ reader; and the file must hold exactly what its header announces.
#pragma once

#include <string>
#include <string_view>

#include "encoder/meshes/input_format.h"
#include "encoder/meshes/mesh_reader.h"

namespace rlpc {

// name: for error messages.
InputResult<SingleMesh> parse_ply(std::string_view text, const std::string& name,
                                  const MeshLimit& limit = {});

extern const InputFormat kPlyFormat;

}  // namespace rlpc
