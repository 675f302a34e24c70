// Spatial values of the trajectories of a GOF, coded in closed loop (8.11 backwards).
#pragma once

#include <cstdint>
#include <vector>

#include "common/mesh/coded_mesh.h"
#include "encoder/skinned_gof/quantise/skinned_analysis.h"
#include "encoder/skinned_gof/quantise/temporal_values.h"

namespace rlpc {

struct SpatialValues {
  std::vector<std::int32_t> residual;  // [num_vertices][trajectory]
  std::vector<std::int32_t> largest;   // [trajectory], magnitude of the values
  double excess = 0.0;                 // of the largest wanted value; above 1 it does not fit
};

// Fits the decoded temporal values in least squares. There is at least one trajectory.
//
//   gof   the analysed one, with its weights of prediction
//   step  of the quantisers, grid units
SpatialValues code_spatial_values(const CodedMesh& mesh, const SkinnedGof& gof,
                                  const SkinnedAnalysis& analysis,
                                  const TemporalValues& temporal, Rounding rounding,
                                  double step);

}  // namespace rlpc
