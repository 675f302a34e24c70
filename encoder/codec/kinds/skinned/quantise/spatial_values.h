// Spatial values of the trajectories of a GOF, coded in closed loop (inverse of 8.11).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/kinds/skinned/quantise/skinned_analysis.h"
#include "encoder/codec/kinds/skinned/quantise/temporal_values.h"

namespace rlpc {

struct SpatialValues {
  std::vector<std::int32_t> residual;  // [num_vertices][trajectory]
  std::vector<std::int32_t> values;    // [num_vertices][trajectory], as decoded
  std::vector<std::int32_t> largest;   // [trajectory], largest magnitude of its values
  double excess = 0.0;  // largest wanted value / largest legal value; above 1 it does not fit
};

// Codes the spatial values that, with the decoded temporal values, fit best in the
// least-squares sense. There must be at least one trajectory.
//
//   rig        that of the analysis, with its weight settings
//   group_end  ends of the component groups, in trajectories
//   shared     the shared rig of a local component group; null: no local component group
//   step       quantiser step, grid units
SpatialValues code_spatial_values(const OrderedMesh& mesh, const SharedRig& rig,
                                  const SkinnedAnalysis& analysis,
                                  const TemporalValues& temporal,
                                  std::span<const std::size_t> group_end,
                                  const RigRecon* shared, Rounding rounding, double step);

}  // namespace rlpc
