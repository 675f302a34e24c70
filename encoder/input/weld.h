// One vertex in place of several that are in the same place in every frame, as files have them
// along the seams of normals and textures.
#pragma once

#include <memory>

#include "encoder/input/frame_source.h"

namespace rlpc {

// Reads all frames. Vertices keep their order, by the first of those that are joined. Drops
// degenerate triangles.
InputResult<std::unique_ptr<FrameSource>> weld(std::unique_ptr<FrameSource> source);

// Leaves out triangles with fewer than three different corners, and notes how many they were.
void drop_degenerate(FrameSource::Shape& shape);

}  // namespace rlpc
