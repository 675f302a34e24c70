// glTF 2.0 as input: the triangles of a scene, moved by skins, morph targets and nodes.
#pragma once

#include <memory>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/gltf/model.h"
#include "encoder/meshes/input_format.h"

namespace rlpc {

// Vertices are in depth-first order of the scene before welding; frames are evaluated on
// demand. An animation is sampled from time 0 to its last key, whose pose is that of its last
// frame, at the frame rate of the options, or one that fits its keys (frame_grid.h); with
// `all`, animations follow one another. Without animations, there is one frame.
//
// Points and lines are dropped. Errors include required extensions that change the mesh.
InputResult<std::unique_ptr<FrameSource>> open_gltf(const InputOptions& options,
                                                    const GltfLimits& limits = {});

extern const InputFormat kGltfFormat;

}  // namespace rlpc
