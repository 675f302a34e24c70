// 6.14: elements of inter GOFs and frame units before their sections, parsing side. Errors are
// left in the reader.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// 6.14 frames_of_gof( ), up to the patch map. num_layers: layers of the mesh. `settings` has
// its layer steps only if its layer groups could be read.
void parse_inter_settings(BitReader& r, const SequenceHeader& header, std::uint32_t num_layers,
                          InterSettings& settings);

// What an inter GOF has frame units of.
struct FrameCounts {
  std::uint32_t frames = 1;
  std::uint32_t layer_groups = 1;
};

// Beginning of 6.14.2 frame_unit( ).
struct FrameUnitStart {
  std::uint32_t frame_idx = 0;
  bool gof_end_flag = false;
  // Unless gof_end_flag is set:
  std::uint32_t layer_group_idx = 0;
  ReadElement unit_frames_minus1;  // 0 if there are layer groups
};

// Parses frame_idx and gof_end_flag. num_frames: frames of the GOF.
FrameUnitStart parse_frame_unit_start(BitReader& r, const SequenceHeader& header,
                                      std::uint32_t num_frames);
// Parses the elements up to frame_start( ).
FrameUnitStart parse_frame_unit_header(BitReader& r, const SequenceHeader& header,
                                       const FrameCounts& counts);

}  // namespace rlpc
