// Wavefront OBJ: vertices and faces, nothing else.
//
// Strict where silence would change the animation (numbers, indices, face sizes), lenient where
// it cannot (other keywords, w and colours after x y z, texture and normal indices). Numbers
// are rounded correctly, so that the same file gives the same stream on every machine.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/frame_source.h"

namespace rlpc {

struct ObjMesh {
  std::vector<float> xyz;               // 3 per vertex, at least one vertex, all finite
  std::vector<Triangle> triangles;      // polygons as fans from their first corner
  std::optional<FrameRate> frame_rate;  // of a comment "# frame_rate N/D"
};

// `name` stands in error messages.
InputResult<ObjMesh> parse_obj(std::string_view text, const std::string& name);
InputResult<ObjMesh> read_obj(const std::string& path);

}  // namespace rlpc
