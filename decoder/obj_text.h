// OBJ text of one frame, for the sinks that write it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/mesh.h"

namespace rlpc {

// "v x y z" per vertex: the shortest numbers that read back as the same float.
void append_obj_vertices(std::string& text, const Grid& grid,
                         std::span<const std::int32_t> positions);
// "f a b c" per triangle.
void append_obj_faces(std::string& text, const std::vector<Triangle>& triangles);
// The comment by which our readers find the frame rate.
void append_obj_frame_rate(std::string& text, FrameRate frame_rate);

}  // namespace rlpc
