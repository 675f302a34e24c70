// Animations of a glTF file, one per clip of the stream.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/mesh.h"
#include "decoder/meshes/gltf/glb_buffers.h"

namespace rlpc {

// Returns the frames of each animation, which together are all frames: the clips, and frames
// between clips as clips named by their numbers; without clips, one clip without a name.
// first_number: number of frame 0 in these names.
std::vector<Clip> animation_spans(std::span<const Clip> clips, std::uint32_t num_frames,
                                  std::uint32_t first_number);

// Makes one animation: samplers, and the channels that they feed.
class GlbAnimation {
 public:
  // Starts an animation of all frames of the clip.
  GlbAnimation(GlbBuffers& buffers, const Clip& clip, FrameRate frame_rate)
      : buffers_(buffers), clip_(clip), frame_rate_(frame_rate) {}

  const Clip& clip() const { return clip_; }
  // Adds a channel. keys: frames of the clip, ascending, at least one; output: accessor of the
  // values.
  void add_channel(std::uint32_t node, const char* path, std::span<const std::uint32_t> keys,
                   std::uint32_t output);
  // Returns whether a channel has keys in the first and in the last frame of the clip.
  bool spans_clip() const;
  // Returns all frames of the clip as keys.
  std::vector<std::uint32_t> all_frames() const;
  // Returns the animation as JSON. Must be called once.
  GltfJson json();

 private:
  std::uint32_t times_of(std::span<const std::uint32_t> keys);

  struct Times {
    std::vector<std::uint32_t> keys;
    std::uint32_t accessor;
  };

  GlbBuffers& buffers_;
  const Clip& clip_;
  FrameRate frame_rate_;
  std::vector<Times> times_;  // keys of all samplers so far
  GltfJson channels_ = GltfJson::array();
  GltfJson samplers_ = GltfJson::array();
};

}  // namespace rlpc
