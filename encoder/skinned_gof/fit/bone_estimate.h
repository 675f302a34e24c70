// What bones of a GOF, and the trajectories of what they leave, are expected to cost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/gof/gof_frames.h"
#include "encoder/skinned_gof/fit/bone_solver.h"

namespace rlpc {

// Lagrangian cost of the whole GOF.
//
//   residuals               [vertex of the sample][3 * frame of the sample], grid units
//   num_vertices, num_frames  of the GOF
//   step                    of the quantisers, grid units
double expected_cost(const BoneSample& sample, std::vector<double> residuals,
                     std::uint32_t num_vertices, std::uint32_t num_frames, double step);

// Of some vertices, how far each is in each frame but the first from where it would be if it
// had gone on as before; grid units.
std::vector<double> unsteadiness(const GofFrames& frames);

// Bits of pivot and poses of one bone among so many (at least 1) in all frames.
//
//   unsteady  of that GOF
//   step      of the quantisers, grid units, above 0
double expected_bone_bits(const std::vector<double>& unsteady, const GofFrames& frames,
                          std::size_t num_bones, double step);

}  // namespace rlpc
