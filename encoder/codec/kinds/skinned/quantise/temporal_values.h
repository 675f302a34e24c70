// Temporal values of the trajectories of a span: selects the components worth coding, quantises
// and predicts their values (inverse of 8.14.2).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/skinned/quantise/skinned_analysis.h"
#include "encoder/codec/spans/component_cost.h"

namespace rlpc {

// tuned (off: 1): Squared error of a temporal value relative to that of a spatial one, with
// bones. The residual of bone motion is confined to few vertices, so that its temporal values
// may be coarser.
inline constexpr double kTemporalErrorOfBones = 2.0;
// tuned (off: 1e9): Where weights adapt to each vertex, with a single bone, errors of temporal
// values grow with the number of spatial factors to each temporal value beyond this one.
// Spatial factors are fitted to decoded temporal values, which absorbs much of their errors.
inline constexpr double kSpatialToTemporal = 2.0;
// tuned (off: 1): They grow at most by this factor.
inline constexpr double kMaxTemporalRise = 2.4;

// Returns the squared error of a temporal value relative to that of a spatial one.
//
//   adapts      weights adapt to each vertex
//   num_frames  frames of the span
inline double temporal_error(const SharedRig& rig, bool adapts, std::size_t num_frames) {
  if (rig.bones.size() > 1) return kTemporalErrorOfBones;
  if (!adapts) return kTemporalError;
  const double spatial_to_temporal =
      static_cast<double>(rig.influences.size()) / (3.0 * static_cast<double>(num_frames));
  return kTemporalError *
         std::clamp(spatial_to_temporal / kSpatialToTemporal, 1.0, kMaxTemporalRise);
}

struct TemporalValues {
  std::vector<std::vector<Trajectory>>
      gof_trajectories;      // [GOF][trajectory], weights and residuals
  std::vector<int> eighths;  // [trajectory], product of both steps is 2^(eighths / 8)
  std::vector<std::vector<Vec3i>> indices;   // [trajectory][frame]
  std::vector<std::vector<double>> decoded;  // [trajectory][3 * num_frames], unit vectors
  std::size_t num_tried = 0;  // number of leading components that factors are computed from

  std::size_t size() const { return eighths.size(); }
};

struct TemporalLimits {
  std::size_t max_trajectories = 0;
  int min_eighths = -1000;  // finest product of steps that fits the format
};

// step: quantiser step, grid units.
TemporalValues code_temporal_values(const SkinnedAnalysis& analysis,
                                    const SkinnedSettings& settings, double step,
                                    const TemporalLimits& limits);

}  // namespace rlpc
