// Merges vertices that coincide in every frame, as files have them along seams of normals and
// textures.
#pragma once

#include <memory>

#include "encoder/input/frame_source.h"

namespace rlpc {

// Reads all frames. Vertices keep their order, that of the first of each group. Drops
// degenerate triangles.
InputResult<std::unique_ptr<FrameSource>> weld(std::unique_ptr<FrameSource> source);

// Drops triangles with fewer than three distinct corners, and adds a note with their number.
void drop_degenerate(FrameSource::Shape& shape);

}  // namespace rlpc
