// Animations of a glTF document as clips: tracks of keys.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/document/document.h"
#include "encoder/meshes/gltf/document/values.h"
#include "encoder/meshes/gltf/track.h"

namespace rlpc {

struct GltfClip {
  struct Channel {
    std::uint32_t node = 0;
    GltfPath path = GltfPath::kTranslation;
    GltfTrack track;
  };

  std::string name;
  std::vector<Channel> channels;
  // A clip begins at time 0: the first pose is held until the first key.
  double first = 0.0;  // first time of all tracks, seconds; may be below 0, which is not played
  double end = 0.0;    // last time of all tracks, at least 0
};

// Returns the first animation names, quoted, for messages.
std::string gltf_animation_names(const GltfDocument& document);

// Returns the animations that `names` select, in their order, each once: names, indices from 0,
// or "all"; without names the first, if any.
std::vector<std::uint32_t> choose_animations(const GltfDocument& document,
                                             std::span<const std::string> names,
                                             GltfErrors& errors);

// Reads an animation; complete only if there are no errors.
GltfClip read_gltf_clip(const GltfDocument& document, std::uint32_t animation,
                        GltfValues& values, GltfErrors& errors);

}  // namespace rlpc
