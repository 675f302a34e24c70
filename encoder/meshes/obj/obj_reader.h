// Wavefront OBJ: vertices and faces, texture coordinates and normals of their corners, colours
// (v x y z r g b), materials, objects and groups.
//
// Strict where silence would change the animation (numbers, indices, face sizes), lenient where
// it cannot (other keywords, w after x y z). Numbers
// are rounded correctly, so that the same file gives the same stream on every machine.
#pragma once

#include <string>
#include <string_view>

#include "encoder/meshes/input_format.h"
#include "encoder/meshes/mesh_reader.h"

namespace rlpc {

// name: for error messages.
InputResult<SingleMesh> parse_obj(std::string_view text, const std::string& name,
                                  const MeshLimit& limit = {});

extern const InputFormat kObjFormat;

}  // namespace rlpc
