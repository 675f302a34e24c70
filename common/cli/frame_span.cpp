#include "common/cli/frame_span.h"

#include <charconv>
#include <system_error>

namespace rlpc {

std::optional<FrameSpan> parse_frame_span(const std::string& text, std::uint32_t num_frames) {
  if (text.empty()) return FrameSpan{0, num_frames - 1};
  const char* const end = text.data() + text.size();
  FrameSpan span{};
  auto [rest, error] = std::from_chars(text.data(), end, span.first);
  if (error != std::errc()) return std::nullopt;
  span.last = span.first;
  if (rest != end) {
    if (*rest++ != '-') return std::nullopt;
    span.last = num_frames - 1;
    if (rest != end) {
      const auto [after, wrong] = std::from_chars(rest, end, span.last);
      if (wrong != std::errc() || after != end) return std::nullopt;
    }
  }
  if (span.first > span.last || span.last >= num_frames) return std::nullopt;
  return span;
}

}  // namespace rlpc
