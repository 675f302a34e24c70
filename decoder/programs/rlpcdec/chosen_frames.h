// Frames that --frames or --clip of rlpcdec selects.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/cli/frame_span.h"
#include "common/codec/mesh/clip.h"
#include "common/result.h"

namespace rlpc {

// Returns the selected frames, or a message for the user. frames: see parse_frame_span(); used
// if `clip` is empty. clips: clips of the stream, which has num_frames frames.
Result<FrameSpan, std::string> choose_frames(const std::string& frames, const std::string& clip,
                                             std::span<const Clip> clips,
                                             std::uint32_t num_frames);

// Returns the parts of clips within a span of frames, counted from its first frame.
std::vector<Clip> clips_within(const FrameSpan& span, std::span<const Clip> clips);

}  // namespace rlpc
