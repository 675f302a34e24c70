// glTF 2.0 as input: the triangles of a scene, moved by skins, morph targets and nodes.
#pragma once

#include <memory>

#include "encoder/input/frame_source.h"
#include "encoder/input/gltf/model.h"
#include "encoder/input/input_format.h"

namespace rlpc {

// Vertices are in the order of the scene, depth first, before welding; frames are evaluated on
// demand. An animation is sampled from its first time to its last, every 1 / frame_rate
// (default 30); `all` animations follow each other. Without animations: one frame.
//
// Points and lines are dropped. Required extensions that change the mesh are refused.
InputResult<std::unique_ptr<FrameSource>> open_gltf(const InputOptions& options,
                                                    const GltfLimits& limits = {});

extern const InputFormat kGltfFormat;

}  // namespace rlpc
