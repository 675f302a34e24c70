// Estimates the cost of bones, and of the trajectories for the residual of bone motion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_solver.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Principal components of the residuals of a whole GOF, as expected from a sample.
struct ResidualSpectrum {
  std::vector<double> energy;     // squared grid units, descending
  std::vector<double> predicted;  // mean square of the prediction residual of a spatial factor
};

// residuals: [vertex of the sample][3 * frame of the sample], grid units
ResidualSpectrum residual_spectrum(const BoneSample& sample, std::vector<double> residuals,
                                   std::uint32_t num_vertices, std::uint32_t num_frames);

// Returns the expected Lagrangian cost of trajectories for the residuals. step: quantiser step,
// grid units.
double expected_cost(const ResidualSpectrum& spectrum, std::uint32_t num_vertices,
                     std::uint32_t num_frames, double step);

// Returns distances, in grid units, between the positions of a sample of vertices and their
// linear extrapolation from the two frames before, for each frame except the first.
std::vector<double> unsteadiness(const SpanFrames& frames);

// Returns the expected bits of the pivot and of all poses of one bone.
//
//   unsteady   unsteadiness() of the frames
//   num_bones  number of bones in the GOF, at least 1
//   step       quantiser step, grid units, above 0
double expected_bone_bits(const std::vector<double>& unsteady, const SpanFrames& frames,
                          std::size_t num_bones, double step);

}  // namespace rlpc
