// What the trajectories of a GOF are expected to cost, from a sample of what bones leave.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/bone_solver.h"

namespace rlpc {

// Squared error, with bits at their worth (kErrorPerBit), of the whole GOF.
//
//   residuals               [vertex of the sample][3 * frame of the sample], grid units
//   num_vertices, num_frames  of the GOF
//   step                    of the quantisers, grid units
double expected_cost(const BoneSample& sample, const std::vector<double>& residuals,
                     std::uint32_t num_vertices, std::uint32_t num_frames, double step);

}  // namespace rlpc
