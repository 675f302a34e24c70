// Chooses the grid of a sequence: fine enough for the target error, within the limits of the
// format.
#pragma once

#include <array>

#include "common/codec/mesh/mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

struct Extent {
  std::array<double, 3> min{};
  std::array<double, 3> max{};
  double rms_spread = 0.0;  // RMS of the coordinates about the mean of their frame, units
};

// Reads every frame once. Errors: errors of the source; coordinates beyond 2^100.
InputResult<Extent> measure_extent(FrameSource& source);

struct GridChoice {
  Grid grid;
  int position_bits = 0;
};

// Returns the error, in units, that the target asks for; 0 if that is not known in advance. A
// much finer grid would gain nothing and cost bits, because steps are limited to a maximum
// number of grid steps. rms_spread: as in Extent.
double finest_error(const Target& target, double rms_spread);

// Returns the coarsest suitable grid. finest_error: smallest error that matters, units; 0:
// unknown.
GridChoice choose_grid(const Extent& extent, double finest_error);

inline void set_grid(SequenceHeader& header, const GridChoice& choice) {
  header.grid = choice.grid;
  header.position_bits = choice.position_bits;
}

}  // namespace rlpc
