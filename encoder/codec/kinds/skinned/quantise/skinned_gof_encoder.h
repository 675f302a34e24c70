// Quantisation of a span of skinned GOFs: trajectories, their spatial factors, and the division
// into slices (inverse of clauses 8.10, 8.11 and 8.14).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/kinds/skinned/quantise/skinned_analysis.h"

namespace rlpc {

// Whether at least `count` (above 0) principal components are worth coding as trajectories.
bool has_trajectories(std::size_t count, const SkinnedAnalysis& analysis,
                      const SkinnedSettings& settings, double step);

// Estimates the squared error of a GOF with one bone: each component adds about its energy or
// its quantisation error, whichever is smaller. The actual error is 0.6 to 1.6 times the
// estimate, a factor that is almost independent of the step.
double expected_squared_error(const SkinnedAnalysis& analysis, double step);

// A span as coded: the rig that its GOFs share, and the tracks of each GOF.
struct CodedSpan {
  SharedRig rig;
  std::vector<SkinnedGof> gofs;  // bones and trajectories with their motion, nothing else
  // Spatial values of the trajectories, as decoded, [num_vertices][trajectory]; empty if there
  // are none, or those of a shared rig.
  std::vector<std::int32_t> values = {};
};

// Quantises the trajectories and completes the span. step: quantiser step, grid units.
CodedSpan code_skinned_span(const OrderedMesh& mesh, const SkinnedAnalysis& analysis,
                            const SkinnedSettings& settings, double step);

// Returns the only GOF of a span, with vertices of its own.
SkinnedGof merge_into_gof(CodedSpan coded);
// Trajectories that a skinned GOF adds to those of its shared rig.
struct LocalGroup {
  std::vector<Trajectory> trajectories;  // empty: none is worth its bits
  std::vector<std::int32_t> residual;    // [num_vertices][trajectory]
};

// Codes principal components as a local component group.
//
//   analysis  residual of the shared rig in a single GOF; its rig has no trajectories
//   shared    the shared rig
LocalGroup code_local_group(const OrderedMesh& mesh, const SkinnedAnalysis& analysis,
                            const RigRecon& shared, SkinnedSettings settings, double step);
// Adds a local component group, unless it is empty, to a skinned GOF that uses a shared rig.
void add_local_group(LocalGroup group, SkinnedGof& gof);

// Lets a GOF of a span use a shared rig.
void use_rig(std::shared_ptr<const SharedRig> rig, SkinnedGof& gof);

}  // namespace rlpc
