// glTF 2.0 as input: the triangles of a scene, moved by skins, morph targets and nodes.
#pragma once

#include <memory>

#include "encoder/input/frame_source.h"
#include "encoder/input/gltf/model.h"
#include "encoder/input/input_format.h"

namespace rlpc {

// Vertices are in depth-first order of the scene before welding; frames are evaluated on
// demand. An animation is sampled from its first to its last time at the frame rate (default
// 30); with `all`, animations follow one another. Without animations, there is one frame.
//
// Points and lines are dropped. Errors include required extensions that change the mesh.
InputResult<std::unique_ptr<FrameSource>> open_gltf(const InputOptions& options,
                                                    const GltfLimits& limits = {});

extern const InputFormat kGltfFormat;

}  // namespace rlpc
