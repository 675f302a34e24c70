// Wavefront OBJ: vertices and faces, nothing else.
//
// Strict where silence would change the animation (numbers, indices, face sizes), lenient where
// it cannot (other keywords, w and colours after x y z, texture and normal indices). Numbers
// are rounded correctly, so that the same file gives the same stream on every machine.
#pragma once

#include <string>
#include <string_view>

#include "encoder/input/input_format.h"
#include "encoder/input/mesh_reader.h"

namespace rlpc {

// name: for error messages.
InputResult<SingleMesh> parse_obj(std::string_view text, const std::string& name,
                                  const MeshLimit& limit = {});

extern const InputFormat kObjFormat;

}  // namespace rlpc
