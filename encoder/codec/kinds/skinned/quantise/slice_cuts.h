// Divides a GOF into slices, which a sub-stream extractor can drop.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/kinds/skinned/quantise/skinned_analysis.h"

namespace rlpc {

// Division of trajectories and layers into groups.
struct SliceCuts {
  // Ends of the component groups, in trajectories; the last is their number. Empty: no groups.
  std::vector<std::size_t> group_end;
  std::size_t num_layer_groups = 1;  // maximum
};

// Makes as many groups as the settings request, otherwise as many as the overhead of slices
// allows.
//
//   bits   approximate bits of the spatial factors
//   count  number of trajectories
SliceCuts choose_slice_cuts(const SkinnedSettings& settings, double bits, std::size_t count);

// Divides layers and trajectories into groups.
//
//   residual  [num_vertices][trajectory of the GOF]
//   gof       its trajectories are set; layer groups, component groups and slices are added
void cut_slices(const OrderedMesh& mesh, const SkinnedSettings& settings, const SliceCuts& cuts,
                std::span<const std::int32_t> residual, SharedRig& rig);

}  // namespace rlpc
