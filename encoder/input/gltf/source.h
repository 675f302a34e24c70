// glTF 2.0 as input: the triangles of a scene, moved by skins, morph targets and nodes.
#pragma once

#include <memory>

#include "encoder/input/frame_source.h"
#include "encoder/input/gltf/model.h"
#include "encoder/input/input_format.h"

namespace rlpc {

// Vertices are in the order of the scene, depth first, until they are welded; each frame is
// evaluated when it is asked for. The frames of an animation are at its first time and then
// every 1 / frame_rate (default 30) up to its last; those of `all` animations follow each
// other. Without animations: one frame.
//
// Points and lines are left out. Extensions that change the mesh are refused if required.
InputResult<std::unique_ptr<FrameSource>> open_gltf(const InputOptions& options,
                                                    const GltfLimits& limits = {});

extern const InputFormat kGltfFormat;

}  // namespace rlpc
