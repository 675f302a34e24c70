// Temporal values of the trajectories of a span: selects the components worth coding, quantises
// and predicts their values (inverse of 8.14.2).
#pragma once

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
// Returns the squared error of a temporal value relative to that of a spatial one. num_frames:
// of all GOFs that use the rig.
double temporal_error(const SharedRig& rig, std::size_t num_frames);

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
  std::size_t min_trajectories = 0;
  int min_eighths = -1000;  // finest product of steps that fits the format
};

// step: quantiser step, grid units.
TemporalValues code_temporal_values(const SkinnedAnalysis& analysis,
                                    const SkinnedSettings& settings, double step,
                                    const TemporalLimits& limits);

}  // namespace rlpc
