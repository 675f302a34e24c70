// The frames that an option names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace rlpc {

struct FrameSpan {
  std::uint32_t first;
  std::uint32_t last;
};

// "A-B", "A" or "A-" of frames 0 to num_frames - 1; empty: all of them. None if it is wrong.
std::optional<FrameSpan> parse_frame_span(const std::string& text, std::uint32_t num_frames);

}  // namespace rlpc
