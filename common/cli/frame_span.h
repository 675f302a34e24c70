// Frames that an option names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace rlpc {

struct FrameSpan {
  std::uint32_t first;
  std::uint32_t last;
};

// Parses "A-B", "A" or "A-", with frames 0 to num_frames - 1; empty: all frames. None if the
// text is invalid.
std::optional<FrameSpan> parse_frame_span(const std::string& text, std::uint32_t num_frames);

}  // namespace rlpc
