// Merges vertices that coincide in every frame: many files duplicate vertices along seams of
// normals and textures.
#pragma once

#include <memory>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Reads all frames. Each group of coinciding vertices becomes one vertex, in the place of its
// first. Drops degenerate triangles. Errors: errors of the source.
InputResult<std::unique_ptr<FrameSource>> weld(std::unique_ptr<FrameSource> source);

// Drops triangles with fewer than three distinct corners, and adds a note with their number.
void drop_degenerate(FrameSource::Shape& shape);

}  // namespace rlpc
