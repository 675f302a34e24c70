// Properties of a sequence that is encoded frame by frame.
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
  SourceAttributes attributes{};    // indices are not checked
  std::vector<Clip> clips{};        // for EncoderSettings::takes_from_source
  std::string asset{};              // for EncoderSettings::takes_from_source
  // Bounding box of all frames, in units, within 2^100. A box that is much too large makes the
  // grid coarser.
  std::array<float, 3> box_min{};
  std::array<float, 3> box_max{};
  // Largest distance of a vertex from the floats that it is rounded to, in units, if frames are
  // added with their exact numbers. With low delay, Target::kMaxError includes it.
  double max_rounding = 0.0;
  std::uint32_t least_level = 1;  // lowest level that the stream may declare, 1 to kMaxLevelIdc
  // High profile: maximum number of frames that are held and encoded together, but at least one
  // GOF. With fewer frames, bytes come sooner, but there are more of them. 0: as many as
  // encode() encodes together, up to 2^23 positions.
  std::uint32_t max_held_frames = 0;
};

}  // namespace rlpc
