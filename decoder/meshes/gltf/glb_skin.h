// An animation as a skin: joints that move a rest shape, and morph targets for what they leave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/skeleton.h"
#include "decoder/meshes/gltf/glb_document.h"
#include "decoder/meshes/gltf/gltf_look.h"
#include "decoder/meshes/gltf/skin_joints.h"
#include "decoder/meshes/gltf/skin_shape.h"

namespace rlpc {

struct GlbSkin {
  std::size_t num_joints = 0;
  std::size_t num_targets = 0;  // of positions and of normals
  SkinError error;              // against the frames
  double stream_rms = 0;        // the error that the stream is likely to have itself
  bool lacks_normals = false;   // targets for them were left out, for their memory
};

// What a skin is made of.
struct SkinSource {
  std::shared_ptr<const Skeleton> skeleton;
  Grid grid;
  std::vector<JointPlaces> places;         // [frame][bone]; empty: not known
  std::vector<std::vector<float>> frames;  // [frame], of the vertices of the stream
  std::size_t num_values = 0;              // coded for frames whose places are known
};

struct SkinLimits {
  std::size_t max_targets = 0;
  std::uint64_t max_normal_bytes = 0;  // memory for normals of all frames
};

// Fills the document. source: places that are not known are fitted. spans: of
// animation_spans().
GlbSkin add_skin(GlbDocument& document, const GltfLook& look, SkinSource& source,
                 std::span<const Clip> spans, FrameRate frame_rate, const SkinLimits& limits);

}  // namespace rlpc
