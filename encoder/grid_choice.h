// The grid of a sequence: fine enough for the wanted error, no finer than positions can be
// coded.
#pragma once

#include <array>

#include "common/mesh.h"
#include "encoder/input/frame_source.h"

namespace rlpc {

struct Extent {
  std::array<double, 3> min{};
  std::array<double, 3> max{};
  double rms_spread = 0.0;  // of a coordinate about the mean of its frame, units
};

// Reads every frame once. Error: those of the source, and coordinates beyond 2^100.
InputResult<Extent> measure_extent(FrameSource& source);

struct GridChoice {
  Grid grid;
  int position_bits = 0;
};

// finest_error: the smallest error, in units, that matters; 0 if unknown.
GridChoice choose_grid(const Extent& extent, double finest_error);

}  // namespace rlpc
