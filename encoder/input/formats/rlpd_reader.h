// Reads decoder output (.rlpd, Annex A) as input.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "encoder/input/frame_source.h"
#include "encoder/input/input_format.h"

namespace rlpc {

// Reads the frames that are present, which may be fewer than the header states.
InputResult<std::unique_ptr<FrameSource>> open_rlpd(
    const std::string& path, const std::optional<FrameRate>& frame_rate,
    std::uint64_t max_memory_bytes = kUsualEncoderBytes);

extern const InputFormat kRlpdFormat;

}  // namespace rlpc
