// Animations of a glTF document as clips: tracks, and the times of frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/input/gltf/document/document.h"
#include "encoder/input/gltf/document/values.h"
#include "encoder/input/gltf/track.h"

namespace rlpc {

struct GltfClip {
  struct Channel {
    std::uint32_t node = 0;
    GltfPath path = GltfPath::kTranslation;
    GltfTrack track;
  };

  std::vector<Channel> channels;
  double start = 0.0;  // seconds: the first time of any track, and the last
  double end = 0.0;

  // Frames from the start on, as long as they are not past the end: not by more than a
  // thousandth of a frame, and than times are rounded as 32-bit floats.
  double num_frames(const FrameRate& rate) const;
  // Rounded as the times of keys are, so that a frame at a key is exactly that key.
  double time_of(std::uint32_t frame, const FrameRate& rate) const;
};

// For messages: the first ones, quoted.
std::string gltf_animation_names(const GltfDocument& document);

// Which animations `name` means: "" the first if any, "all", a name, or an index from 0.
std::vector<std::uint32_t> choose_animations(const GltfDocument& document,
                                             const std::string& name, GltfErrors& errors);

// Whole only if there are no errors.
GltfClip read_gltf_clip(const GltfDocument& document, std::uint32_t animation,
                        GltfValues& values, GltfErrors& errors);

}  // namespace rlpc
