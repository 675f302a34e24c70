// Quantisation of one GOF of the Main profile: trajectories, their spatial factors, and the
// slices that these are cut into (clauses 8.10, 8.11 and 8.14 backwards).
#pragma once

#include "common/bone_gof.h"
#include "common/coded_mesh.h"
#include "encoder/bone_analysis.h"

namespace rlpc {

// How many of the principal components are worth a trajectory.
std::size_t num_trajectories(const BoneAnalysis& analysis, double step);

// The GOF ready to be written.
BoneGof code_bone_gof(const CodedMesh& mesh, const BoneAnalysis& analysis,
                      const BoneSettings& settings, double step);

}  // namespace rlpc
