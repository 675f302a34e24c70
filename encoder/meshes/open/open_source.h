// Opens an input of any format, by its name or contents.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/frame_stream.h"

namespace rlpc {

// Opens the input and checks it as far as possible without reading every frame; read_frame()
// checks the rest.
InputResult<std::unique_ptr<FrameSource>> open_frame_source(const InputOptions& options);

// Whether the format may contain several animations, and vertices to weld.
bool has_clips(const InputOptions& options);
// Returns an error if glTF options (animation, no welding) are set for other input, or if
// points are given for glTF.
std::optional<InputError> check_gltf_options(const InputOptions& options);

// Opens the frames of a .rlpd file (Annex A) or of a PC2 point cache that comes through `file`,
// which is not owned. The number of frames in its header is ignored: frames are read to the
// end. mesh_path: the triangles of a point cache; empty: the format is .rlpd. Errors: a bad
// header or mesh; a frame that would not fit max_memory_bytes.
InputResult<std::unique_ptr<FrameStream>> open_frame_stream(
    std::FILE* file, const std::string& mesh_path, const std::optional<FrameRate>& frame_rate,
    std::uint64_t max_memory_bytes = kUsualEncoderBytes);

}  // namespace rlpc
