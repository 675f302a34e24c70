// The grid of a sequence: fine enough for the wanted error, no finer than positions can be
// coded.
#pragma once

#include <array>

#include "common/mesh/mesh.h"
#include "common/syntax/sequence_header.h"
#include "encoder/input/frame_source.h"
#include "encoder/rlpc_encoder.h"

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

// The smallest error, in units, that matters to a target; 0 if that is not known before. A grid
// that is far finer than the error is no better, and costs bits: steps have a largest size.
// rms_spread: as in Extent.
double finest_error(const Target& target, double rms_spread);

// finest_error: 0 if unknown.
GridChoice choose_grid(const Extent& extent, double finest_error);

inline void set_grid(SequenceHeader& header, const GridChoice& choice) {
  header.grid = choice.grid;
  header.position_bits = choice.position_bits;
}

}  // namespace rlpc
