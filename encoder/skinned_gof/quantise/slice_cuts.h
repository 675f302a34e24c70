// The slices of a GOF, at which a stream can be cut.
#pragma once

#include <cstdint>
#include <span>

#include "common/mesh/coded_mesh.h"
#include "common/skinned_gof/skinned_gof.h"
#include "encoder/skinned_gof/quantise/skinned_analysis.h"

namespace rlpc {

// Cuts layers and trajectories into groups: as many as cost little beside what they hold, or as
// many as are asked for.
//
//   residual  [num_vertices][trajectory of the GOF]
void cut_slices(const CodedMesh& mesh, const SkinnedSettings& settings,
                std::span<const std::int32_t> residual, SkinnedGof& gof);

}  // namespace rlpc
