// Point caches (PC2): the positions of an animation whose triangles are in an OBJ file.
//
// "POINTCACHE2\0", int32 version = 1, int32 points, float start, float sample rate, int32
// samples; then x, y, z of each point of each sample; 32-bit floats, little-endian. Start and
// sample rate are not used (see InputOptions).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "encoder/frame_source.h"

namespace rlpc {

InputResult<std::unique_ptr<FrameSource>> open_pc2(const std::string& mesh_path,
                                                   const std::string& points_path,
                                                   const std::optional<FrameRate>& frame_rate);

}  // namespace rlpc
