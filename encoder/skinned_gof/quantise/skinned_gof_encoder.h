// Quantisation of one GOF of the Main profile: trajectories, their spatial factors, and the
// slices that these are cut into (clauses 8.10, 8.11 and 8.14 backwards).
#pragma once

#include <cstddef>

#include "common/mesh/coded_mesh.h"
#include "common/skinned_gof/skinned_gof.h"
#include "encoder/skinned_gof/quantise/skinned_analysis.h"

namespace rlpc {

// Whether as many principal components are worth a trajectory.
bool has_trajectories(std::size_t count, const SkinnedAnalysis& analysis,
                      const SkinnedSettings& settings, double step);

// Squared error of a GOF of one bone, but for a factor that hardly depends on the step, of
// about 0.6 to 1.6: components are left out or quantised, whichever errs less.
double expected_squared_error(const SkinnedAnalysis& analysis, double step);

// The GOF ready to be written.
SkinnedGof code_skinned_gof(const CodedMesh& mesh, const SkinnedAnalysis& analysis,
                            const SkinnedSettings& settings, double step);

}  // namespace rlpc
