// Divides a GOF into slices, which a sub-stream extractor can drop.
#pragma once

#include <cstdint>
#include <span>

#include "common/mesh/coded_mesh.h"
#include "common/skinned_gof/skinned_gof.h"
#include "encoder/skinned_gof/quantise/skinned_analysis.h"

namespace rlpc {

// Divides layers and trajectories into groups: as many as the settings request, otherwise as
// many as the overhead of slices allows.
//
//   residual  [num_vertices][trajectory of the GOF]
//   gof       its trajectories are set; layer groups, component groups and slices are added
void cut_slices(const CodedMesh& mesh, const SkinnedSettings& settings,
                std::span<const std::int32_t> residual, SkinnedGof& gof);

}  // namespace rlpc
