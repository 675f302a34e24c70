// Frames that repeat earlier ones, such as those of a cycle or of a pose that is held.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/frame_gof/frame_order.h"

namespace rlpc {

// Whether two frames are equal once their coordinates, in grid units, are rounded to the grid.
bool are_equal_on_grid(std::span<const double> xyz, std::span<const double> other);

// By place in coding order: how many places before the frame is the last one that is equal to
// it on the grid, and whose temporal layer is not higher; 0 if there is none.
//
//   xyz           [num_frames][values], in output order, grid units
//   max_distance  of those that count
std::vector<std::uint32_t> repeat_distances(const FramePattern& pattern,
                                            std::span<const double> xyz, std::size_t values,
                                            std::uint32_t max_distance);

}  // namespace rlpc
