// Point caches (PC2, MDD): the positions of an animation whose triangles are in a mesh file.
//
// PC2: "POINTCACHE2\0", int32 version = 1, int32 points, float start, float sample rate, int32
// samples; then x, y, z of each point of each sample; 32-bit, little-endian.
// MDD: int32 frames, int32 points, a float time for each frame; then x, y, z of each point of
// each frame; 32-bit, big-endian.
// Start and sample rate of PC2 are not used (see InputOptions).
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/frame_stream.h"
#include "encoder/meshes/input_format.h"

namespace rlpc {

// PC2 is recognised by its signature, MDD by its extension. Other files, and standard input,
// are MDD if the header matches the mesh and the file size.
InputResult<std::unique_ptr<FrameSource>> open_point_cache(const InputOptions& options);

// Opens a PC2 file from a pipe, frame by frame; see open_frame_stream().
InputResult<std::unique_ptr<FrameStream>> open_pc2_stream(
    std::FILE* file, const std::string& name, const std::string& mesh_path,
    const std::optional<FrameRate>& frame_rate, std::uint64_t max_memory_bytes);

extern const InputFormat kPc2Format;
extern const InputFormat kMddFormat;

}  // namespace rlpc
