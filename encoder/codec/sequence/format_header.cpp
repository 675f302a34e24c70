#include "encoder/codec/sequence/format_header.h"

#include <algorithm>

#include "encoder/codec/sequence/choices/grid_choice.h"
#include "encoder/codec/sequence/choices/lossless_grid.h"

namespace rlpc {

SequenceHeader header_of(const FrameFormat& format, const EncoderSettings& settings) {
  SequenceHeader header;
  header.profile_idc = static_cast<std::uint32_t>(settings.profile);
  header.num_vertices = format.num_vertices;
  header.num_triangles = static_cast<std::uint32_t>(format.triangles.size());
  header.open_end_flag = format.num_frames == 0;
  header.num_frames = header.open_end_flag ? kMaxFrames : format.num_frames;
  header.frame_rate = format.frame_rate;
  return header;
}

void set_grid_of_box(SequenceHeader& header, const FrameFormat& format, const Target& target,
                     double finest_error) {
  // The finer grid also keeps steps far below their maximum.
  constexpr double kReserve = 16.0;  // fixed: four bits of the grid
  Extent extent;
  std::copy_n(format.box_min.begin(), 3, extent.min.begin());
  std::copy_n(format.box_max.begin(), 3, extent.max.begin());
  set_grid(header, target.kind == Target::kLossless
                       ? grid_of_bits(extent, static_cast<int>(target.value))
                       : choose_grid(extent, finest_error / kReserve));
}

}  // namespace rlpc
