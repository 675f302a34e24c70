// Frames as morph targets: frame 0 is the mesh, every other frame that differs from it a morph
// target with weight 1 at the time of the frame. Viewers interpolate in between (LINEAR).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/mesh.h"
#include "decoder/meshes/gltf/glb_document.h"
#include "decoder/meshes/gltf/glb_mesh.h"
#include "decoder/meshes/gltf/gltf_look.h"

namespace rlpc {

class GltfMorph {
 public:
  // Both must outlive it.
  GltfMorph(GlbDocument& document, const GltfLook& look)
      : document_(document), look_(look), mesh_(look.mesh()) {}

  // xyz of the vertices of the stream.
  void add_frame(std::span<const float> xyz);
  // Completes the document. False if it would be too large. spans: of animation_spans().
  bool finish(std::span<const Clip> spans, FrameRate frame_rate);

  std::size_t num_targets() const { return targets_.size(); }

 private:
  struct Weight {
    std::uint32_t frame;
    std::uint32_t target;
  };

  std::uint32_t add_target(std::uint32_t accessor);
  void add_normal_moves(std::span<const float> xyz);
  std::uint32_t minus_base_target();
  std::uint32_t weights_of(const Clip& clip);

  GlbDocument& document_;
  const GltfLook& look_;
  const GlbMesh& mesh_;
  GltfJson targets_ = GltfJson::array();
  std::vector<Weight> weights_;  // those that are 1, ascending
  std::vector<float> base_;      // frame 0, of output vertices
  std::vector<float> base_normals_;
  GltfJson attributes_;  // of frame 0
  std::optional<std::uint32_t> minus_base_;
  std::uint32_t num_frames_ = 0;
};

}  // namespace rlpc
