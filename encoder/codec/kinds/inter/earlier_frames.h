// Finds frames that equal earlier ones, or nearly: those of a cycle, of a pose that is held, or
// of clips that begin with the same pose.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/inter/frame_order.h"
#include "common/codec/mesh/ordered_mesh.h"

namespace rlpc {

// Whether two frames are equal once their coordinates, in grid units, are rounded to the grid.
bool are_equal_on_grid(std::span<const double> xyz, std::span<const double> other);

// Returns the Reference of 8.19.3 that a frame is predicted from: its reference frames,
// weighted by their distances.
std::vector<double> reference_of(const FramePlace& place, std::span<const double> first,
                                 std::span<const double> second);

struct EarlierFrame {
  std::uint32_t distance = 0;  // places in coding order; 0: no earlier frame
  bool is_equal = false;       // equal on the grid

  bool operator==(const EarlierFrame&) const = default;
};

// Returns, for each place in coding order, the last earlier frame that equals the frame there
// and whose temporal layer is not higher; or else the nearest such frame, if it is nearer than
// the reference of its pattern. Distances are those of a sample of the coordinates; 1024 places
// before each are searched for near frames.
//
//   xyz           [num_frames][values], in output order, grid units
//   max_distance  of those that count
std::vector<EarlierFrame> earlier_frames(const FramePattern& pattern,
                                         std::span<const double> xyz, std::size_t values,
                                         std::uint32_t max_distance);

// Estimates the bits of a frame at a step, in 1/16 grid units, if its vertices are expected to
// move from a reference like the vertices around them.
double bits_from(const OrderedMesh& mesh, std::span<const double> xyz,
                 std::span<const double> reference, std::uint32_t step);

}  // namespace rlpc
