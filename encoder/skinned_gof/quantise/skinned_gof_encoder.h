// Quantisation of one skinned GOF: trajectories, their spatial factors, and the division into
// slices (inverse of clauses 8.10, 8.11 and 8.14).
#pragma once

#include <cstddef>

#include "common/mesh/coded_mesh.h"
#include "common/skinned_gof/skinned_gof.h"
#include "encoder/skinned_gof/quantise/skinned_analysis.h"

namespace rlpc {

// Whether at least `count` principal components are worth coding as trajectories. count: above
// 0.
bool has_trajectories(std::size_t count, const SkinnedAnalysis& analysis,
                      const SkinnedSettings& settings, double step);

// Estimates the squared error of a GOF with one bone: each component adds about its energy or
// its quantisation error, whichever is smaller. The actual error is 0.6 to 1.6 times the
// estimate, a factor that is almost independent of the step.
double expected_squared_error(const SkinnedAnalysis& analysis, double step);

// Quantises the trajectories and completes the GOF. step: quantiser step, grid units.
SkinnedGof code_skinned_gof(const CodedMesh& mesh, const SkinnedAnalysis& analysis,
                            const SkinnedSettings& settings, double step);

}  // namespace rlpc
