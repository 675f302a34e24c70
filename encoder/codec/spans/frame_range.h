// Stretches of a sequence.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rlpc {

// Consecutive frames: `count` of them, starting with frame `first`.
struct FrameRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t num_gofs = 1;  // GOFs of about equal length that it is divided into
};

// Returns `num_spans` spans whose lengths differ by at most one frame.
inline std::vector<FrameRange> equal_ranges(std::uint32_t num_frames, std::uint64_t num_spans) {
  std::vector<FrameRange> spans;
  for (std::uint64_t g = 0; g < num_spans; ++g) {
    const auto first = static_cast<std::uint32_t>(num_frames * g / num_spans);
    const auto next = static_cast<std::uint32_t>(num_frames * (g + 1) / num_spans);
    spans.push_back({first, next - first});
  }
  return spans;
}

// Returns the fewest spans of at most `longest` frames.
inline std::vector<FrameRange> equal_gofs(std::uint32_t num_frames, std::uint32_t longest) {
  return equal_ranges(num_frames, (std::uint64_t{num_frames} + longest - 1) / longest);
}

// Divides spans into GOFs of at most `longest` frames.
inline void divide_spans(std::vector<FrameRange>& spans, std::uint32_t longest) {
  for (FrameRange& span : spans) span.num_gofs = (span.count - 1) / longest + 1;
}

// Returns the number of frames of the longest GOF of some spans.
inline std::uint32_t longest_gof(const std::vector<FrameRange>& spans) {
  std::uint32_t longest = 0;
  for (const FrameRange& span : spans) {
    longest = std::max(longest, (span.count - 1) / span.num_gofs + 1);
  }
  return longest;
}

}  // namespace rlpc
