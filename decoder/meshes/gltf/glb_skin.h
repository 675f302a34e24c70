// Animation as a skin: joints that move a rest shape, and morph targets for the residual.
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
  std::size_t num_targets = 0;  // targets of positions and normals
  SkinError error;              // distance from the frames
  double stream_rms = 0;        // likely error of the stream itself
  bool lacks_normals = false;   // targets of normals were left out, as they need memory
};

// Frames, skeleton and places of joints from which a skin is made.
struct SkinSource {
  std::shared_ptr<const Skeleton> skeleton;
  Grid grid;
  std::vector<JointPlaces> places;         // [frame][bone]; a frame may be empty: unknown
  std::vector<std::vector<float>> frames;  // [frame][3 * vertex of the stream + axis]
  std::size_t num_values = 0;              // values coded for frames with known places
};

struct SkinLimits {
  std::size_t max_targets = 0;
  std::uint64_t max_normal_bytes = 0;  // memory for normals of all frames
};

// Fills the document, and fits unknown places of the source. spans: see animation_spans().
GlbSkin add_skin(GlbDocument& document, const GltfLook& look, SkinSource& source,
                 std::span<const Clip> spans, FrameRate frame_rate, const SkinLimits& limits);

}  // namespace rlpc
