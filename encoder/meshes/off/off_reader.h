// OFF: vertices and polygons of the text form; colours, normals and texture coordinates after
// the positions are dropped, with a note.
#pragma once

#include <string>
#include <string_view>

#include "encoder/meshes/input_format.h"
#include "encoder/meshes/mesh_reader.h"

namespace rlpc {

// Whether the text begins with OFF, possibly after letters for further vertex data (STCN4n).
bool looks_like_off(std::string_view text);

// name: for error messages.
InputResult<SingleMesh> parse_off(std::string_view text, const std::string& name,
                                  const MeshLimit& limit = {});

extern const InputFormat kOffFormat;

}  // namespace rlpc
