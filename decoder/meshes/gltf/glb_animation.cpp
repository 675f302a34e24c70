#include "decoder/meshes/gltf/glb_animation.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/files/float_position.h"

namespace rlpc {

std::vector<Clip> animation_spans(std::span<const Clip> clips, std::uint32_t num_frames,
                                  std::uint32_t first_number) {
  if (clips.empty()) return {{"", 0, num_frames}};
  std::vector<Clip> spans(clips.begin(), clips.end());
  std::vector<bool> is_named(num_frames);
  for (const Clip& clip : spans) {
    std::fill_n(is_named.begin() + clip.first_frame, clip.num_frames, true);
  }
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    if (is_named[f]) continue;
    const auto end = std::find(is_named.begin() + f, is_named.end(), true);
    const auto count = static_cast<std::uint32_t>(end - is_named.begin()) - f;
    spans.push_back({"frames " + std::to_string(first_number + f) + "-" +
                         std::to_string(first_number + f + count - 1),
                     f, count});
    f += count - 1;
  }
  return spans;
}

std::vector<std::uint32_t> GlbAnimation::all_frames() const {
  std::vector<std::uint32_t> keys(clip_.num_frames);
  std::iota(keys.begin(), keys.end(), 0U);
  return keys;
}

std::uint32_t GlbAnimation::times_of(std::span<const std::uint32_t> keys) {
  for (const Times& known : times_) {
    if (std::ranges::equal(known.keys, keys)) return known.accessor;
  }
  std::vector<float> seconds;
  for (const std::uint32_t f : keys) seconds.push_back(frame_time(frame_rate_, f));
  times_.push_back({{keys.begin(), keys.end()}, buffers_.add_times(seconds)});
  return times_.back().accessor;
}

void GlbAnimation::add_channel(std::uint32_t node, const char* path,
                               std::span<const std::uint32_t> keys, std::uint32_t output) {
  channels_.push_back(
      {{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
  samplers_.push_back({{"input", times_of(keys)}, {"output", output}});  // LINEAR
}

bool GlbAnimation::spans_clip() const {
  return std::ranges::any_of(times_, [&](const Times& times) {
    return times.keys.front() == 0 && times.keys.back() + 1 == clip_.num_frames;
  });
}

GltfJson GlbAnimation::json() {
  GltfJson animation;
  if (!clip_.name.empty()) animation["name"] = clip_.name;
  animation["channels"] = std::move(channels_);
  animation["samplers"] = std::move(samplers_);
  return animation;
}

}  // namespace rlpc
