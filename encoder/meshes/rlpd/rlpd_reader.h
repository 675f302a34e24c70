// Reads decoder output (.rlpd, Annex A) as input.
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

// Reads the frames that are present, which may be fewer than the header states.
InputResult<std::unique_ptr<FrameSource>> open_rlpd(
    const std::string& path, const std::optional<FrameRate>& frame_rate,
    std::uint64_t max_memory_bytes = kUsualEncoderBytes);

// Opens it from a pipe, frame by frame; see open_frame_stream().
InputResult<std::unique_ptr<FrameStream>> open_rlpd_stream(
    std::FILE* file, const std::string& name, const std::optional<FrameRate>& frame_rate,
    std::uint64_t max_memory_bytes);

extern const InputFormat kRlpdFormat;

}  // namespace rlpc
