#include "encoder/meshes/gltf/clip.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <system_error>

#include "encoder/meshes/mesh_text.h"

namespace rlpc {

namespace {

using std::to_string;

void check_ascending(const std::vector<float>& times, std::uint32_t accessor,
                     GltfErrors& errors) {
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i - 1] < times[i]) continue;
    errors.expected(gltf_accessor_path(accessor) + ", element " + to_string(i),
                    shortest_text(times[i]),
                    "a time after the one before, " + shortest_text(times[i - 1]));
  }
}

// Rejects zero quaternions.
void check_rotations(const GltfTrack& track, std::uint32_t accessor, GltfErrors& errors) {
  const bool cubic = track.interpolation == GltfInterpolation::kCubicSpline;
  for (std::size_t i = cubic ? 1 : 0; i < track.values.size() / 4; i += cubic ? 3 : 1) {
    const float* const q = &track.values[4 * i];
    if (std::any_of(q, q + 4, [](float x) { return x != 0; })) continue;
    errors.expected(gltf_accessor_path(accessor) + ", element " + to_string(i), "zeros",
                    "a unit quaternion");
  }
}

class ClipReader {
 public:
  ClipReader(const GltfDocument& document, std::uint32_t animation, GltfValues& values,
             GltfErrors& errors)
      : document_(document),
        animation_(document.animations[animation]),
        path_("animations[" + to_string(animation) + "]"),
        values_(values),
        errors_(errors) {}

  GltfClip read() {
    GltfClip clip;
    clip.name = animation_.name;
    for (std::size_t i = 0; i < animation_.channels.size() && !errors_; ++i) {
      const GltfAnimation::Channel& channel = animation_.channels[i];
      check_target(channel);
      if (errors_) break;
      clip.channels.push_back({channel.node, channel.path, read_track(channel)});
      if (errors_) break;
      const std::vector<float>& times = clip.channels.back().track.times;
      clip.first = i == 0 ? times.front() : std::min<double>(clip.first, times.front());
      clip.end = std::max<double>(clip.end, times.back());
    }
    return clip;
  }

 private:
  std::size_t width_of(const GltfAnimation::Channel& channel) const {
    if (channel.path == GltfPath::kRotation) return 4;
    if (channel.path != GltfPath::kWeights) return 3;
    const auto mesh = document_.nodes[channel.node].mesh;
    return mesh ? document_.meshes[*mesh].num_targets : 0;
  }

  void check_target(const GltfAnimation::Channel& channel) {
    const std::string node = "nodes[" + to_string(channel.node) + "]";
    if (channel.path == GltfPath::kWeights) {
      if (width_of(channel) > 0) return;
      errors_.expected(node + ".mesh", "none with morph targets",
                       "some, as " + path_ + " moves them");
    } else if (document_.nodes[channel.node].matrix) {
      errors_.expected(node, "a matrix",
                       "translation, rotation and scale, as " + path_ + " moves it");
    }
  }

  GltfTrack read_track(const GltfAnimation::Channel& channel) {
    using Integers = GltfValues::Integers;
    const GltfAnimation::Sampler& sampler = animation_.samplers[channel.sampler];
    GltfTrack track;
    track.interpolation = sampler.interpolation;
    track.width = width_of(channel);
    track.times = values_.floats(sampler.input, "SCALAR", Integers::kNo);
    check_ascending(track.times, sampler.input, errors_);
    const bool fraction =
        channel.path == GltfPath::kRotation || channel.path == GltfPath::kWeights;
    const char* const type = channel.path == GltfPath::kRotation  ? "VEC4"
                             : channel.path == GltfPath::kWeights ? "SCALAR"
                                                                  : "VEC3";
    if (errors_) return track;
    check_count(channel, track);
    if (errors_) return track;
    track.values =
        values_.floats(sampler.output, type, fraction ? Integers::kToo : Integers::kNo);
    if (channel.path == GltfPath::kRotation) check_rotations(track, sampler.output, errors_);
    return track;
  }

  // Checks that there are as many values as the times require.
  void check_count(const GltfAnimation::Channel& channel, const GltfTrack& track) {
    const GltfAnimation::Sampler& sampler = animation_.samplers[channel.sampler];
    const bool cubic = track.interpolation == GltfInterpolation::kCubicSpline;
    const std::uint64_t each =
        (cubic ? 3 : 1) * (channel.path == GltfPath::kWeights ? track.width : 1);
    const std::uint64_t count = values_.accessor(sampler.output).count;
    if (count == track.times.size() * each) return;
    errors_.expected(gltf_accessor_path(sampler.output) + ".count", to_string(count),
                     to_string(track.times.size() * each) + ", " + to_string(each) +
                         " for each of the " + to_string(track.times.size()) + " times in " +
                         gltf_accessor_path(sampler.input));
  }

  const GltfDocument& document_;
  const GltfAnimation& animation_;
  const std::string path_;
  GltfValues& values_;
  GltfErrors& errors_;
};

// Returns the animations that one name selects; none with an error.
std::vector<std::uint32_t> animations_of(const GltfDocument& document, const std::string& name,
                                         GltfErrors& errors) {
  const auto count = static_cast<std::uint32_t>(document.animations.size());
  if (name == "all" && count == 0) {
    errors.add("animations",
               "none there, though all are chosen; without 'animations', the file "
               "is a single frame");
    return {};
  }
  if (name == "all") {
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }
  std::vector<std::uint32_t> named;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (document.animations[i].name == name) named.push_back(i);
  }
  if (named.size() == 1) return named;
  if (named.size() > 1) {
    errors.add("animations", "the name " + gltf_quoted(name) + " is that of " +
                                 to_string(named.size()) + " there; give an index, such as " +
                                 to_string(named[0]) + " or " + to_string(named[1]));
    return {};
  }
  std::uint32_t index = 0;
  const char* const last = name.data() + name.size();
  const auto [end, ec] = std::from_chars(name.data(), last, index);
  if (ec == std::errc() && end == last && index < count) return {index};
  errors.add("animations",
             "no " + gltf_quoted(name) + " there; " +
                 (count == 0 ? "the file has none"
                             : "expected all, an index below " + to_string(count) +
                                   ", or one of " + gltf_animation_names(document)));
  return {};
}

}  // namespace

std::string gltf_animation_names(const GltfDocument& document) {
  constexpr std::size_t kMax = 20;
  std::string text;
  for (std::size_t i = 0; i < document.animations.size() && i < kMax; ++i) {
    text += (i > 0 ? ", " : "") + gltf_quoted(document.animations[i].name);
  }
  return text + (document.animations.size() > kMax ? ", ..." : "");
}

std::vector<std::uint32_t> choose_animations(const GltfDocument& document,
                                             std::span<const std::string> names,
                                             GltfErrors& errors) {
  std::vector<std::uint32_t> chosen;
  if (names.empty() && !document.animations.empty()) chosen.push_back(0);
  std::vector<bool> is_chosen(document.animations.size());
  for (const std::string& name : names) {
    for (const std::uint32_t i : animations_of(document, name, errors)) {
      if (is_chosen[i]) {
        errors.add("animations", gltf_quoted(document.animations[i].name) +
                                     " is chosen twice; name each animation once");
        return {};
      }
      is_chosen[i] = true;
      chosen.push_back(i);
    }
  }
  return chosen;
}

GltfClip read_gltf_clip(const GltfDocument& document, std::uint32_t animation,
                        GltfValues& values, GltfErrors& errors) {
  return ClipReader(document, animation, values, errors).read();
}

}  // namespace rlpc
