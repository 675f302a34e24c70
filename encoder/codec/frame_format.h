// What is known of a sequence before its first frame.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/mesh.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// Properties of the sequence that must be known before the first frame.
struct FrameFormat {
  std::uint32_t num_vertices = 0;  // at least 1
  // Exactly this many frames must be added. 0: not known (High profile); the stream is
  // open-ended.
  std::uint32_t num_frames = 0;
  FrameRate frame_rate;
  std::vector<Triangle> triangles;  // indices below num_vertices; may be empty
  SourceAttributes attributes{};    // of the triangles; their indices are not checked
  std::vector<Clip> clips{};        // for EncoderSettings::takes_from_source
  std::string asset{};              // for EncoderSettings::takes_from_source
  // Bounding box of all frames, in units, within 2^100. A box that is much too large makes the
  // grid coarser.
  std::array<float, 3> box_min{};
  std::array<float, 3> box_max{};
  // The largest distance of a vertex from the floats that it is rounded to, in units, where
  // frames are added with their exact numbers: with low delay, Target::kMaxError includes it.
  double max_rounding = 0.0;
  std::uint32_t least_level = 1;  // lowest level that the stream may declare, 1 to 4
  // High profile: most frames that are held before they are encoded together, but at least
  // those of one GOF. Fewer mean that bytes come sooner, and that there are more of them. 0: as
  // many as encode() looks at together, 2^23 positions or fewer.
  std::uint32_t max_held_frames = 0;
};

}  // namespace rlpc
