// The frames that --frames or --clip of rlpcdec names.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/cli/frame_span.h"
#include "common/codec/mesh/clip.h"
#include "common/result.h"

namespace rlpc {

// frames: as parse_frame_span() reads it, if no clip is named. clips: those of the stream, of
// num_frames frames. The error is a message for the user.
Result<FrameSpan, std::string> choose_frames(const std::string& frames, const std::string& clip,
                                             std::span<const Clip> clips,
                                             std::uint32_t num_frames);

// The clips, or their parts, that are among the frames of a span, counted from its first frame.
std::vector<Clip> clips_within(const FrameSpan& span, std::span<const Clip> clips);

}  // namespace rlpc
