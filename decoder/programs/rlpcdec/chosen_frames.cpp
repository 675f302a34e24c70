#include "decoder/programs/rlpcdec/chosen_frames.h"

#include <algorithm>
#include <cstddef>

#include "common/files/messages.h"

namespace rlpc {
namespace {

std::string no_such_clip(const std::string& name, std::span<const Clip> clips) {
  if (clips.empty()) return "--clip: the stream has no clips; use --frames";
  constexpr std::size_t kMax = 20;
  std::string names;
  for (std::size_t i = 0; i < clips.size() && i < kMax; ++i) {
    names += (i > 0 ? ", `" : "`") + printable(clips[i].name) + "`";
  }
  return "--clip: no clip `" + name + "`; expected one of " + names +
         (clips.size() > kMax ? ", ..." : "");
}

}  // namespace

Result<FrameSpan, std::string> choose_frames(const std::string& frames, const std::string& clip,
                                             std::span<const Clip> clips,
                                             std::uint32_t num_frames) {
  if (clip.empty()) {
    if (const auto span = parse_frame_span(frames, num_frames)) return *span;
    return "--frames: expected A-B within 0-" + std::to_string(num_frames - 1) + ", got `" +
           frames + "`";
  }
  const auto found =
      std::find_if(clips.begin(), clips.end(), [&](const Clip& c) { return c.name == clip; });
  if (found == clips.end()) return no_such_clip(clip, clips);
  const auto other =
      std::find_if(found + 1, clips.end(), [&](const Clip& c) { return c.name == clip; });
  if (other != clips.end()) {
    return "--clip: several clips are called `" + printable(clip) + "`; use --frames " +
           std::to_string(found->first_frame) + "-" + std::to_string(found->last_frame()) +
           " or " + std::to_string(other->first_frame) + "-" +
           std::to_string(other->last_frame());
  }
  // The clips of an open-ended stream are written before its last frame is known.
  if (found->last_frame() >= num_frames) {
    return "--clip: `" + clip + "` ends with frame " + std::to_string(found->last_frame()) +
           ", but the stream ends with frame " + std::to_string(num_frames - 1) +
           "; use --frames";
  }
  return FrameSpan{found->first_frame, found->last_frame()};
}

std::vector<Clip> clips_within(const FrameSpan& span, std::span<const Clip> clips) {
  std::vector<Clip> within;
  for (const Clip& clip : clips) {
    const std::uint32_t first = std::max(clip.first_frame, span.first);
    const std::uint32_t last = std::min(clip.last_frame(), span.last);
    if (first > last) continue;
    within.push_back({clip.name, first - span.first, last - first + 1});
  }
  return within;
}

}  // namespace rlpc
