// Frames as morph targets: frame 0 is the mesh, and every other frame that differs from it is a
// morph target with weight 1 at its time. Viewers interpolate in between (LINEAR).
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
  // Document and look must outlive it.
  GltfMorph(GlbDocument& document, const GltfLook& look)
      : document_(document), look_(look), mesh_(look.mesh()) {}

  // Adds a frame. xyz: vertices of the stream.
  void add_frame(std::span<const float> xyz);
  // Completes the document. Returns false if it would be too large. spans: see
  // animation_spans().
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
  std::vector<Weight> weights_;  // weights of 1, ascending by frame
  std::vector<float> base_;      // [output vertex][3] positions in frame 0
  std::vector<float> base_normals_;
  GltfJson attributes_;  // accessors of frame 0
  std::optional<std::uint32_t> minus_base_;
  std::uint32_t num_frames_ = 0;
};

}  // namespace rlpc
