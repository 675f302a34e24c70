#include "encoder/codec/kinds/skinned/quantise/slice_cuts.h"

#include <algorithm>
#include <vector>

#include "encoder/codec/spans/layer_groups.h"

namespace rlpc {
namespace {

constexpr double kBytesOfSlice = 4000.0;  // fixed: slices are a feature; they cost 0.2 %

// Returns the ends of groups. The trajectories up to the end of each are about three times as
// many as those before it. A group is smaller if it would not leave enough trajectories for the
// requested number of groups.
std::vector<std::size_t> component_group_ends(std::size_t num_groups, std::size_t requested,
                                              std::size_t count) {
  requested = std::min(requested, count);
  std::vector<std::size_t> ends{count};
  while (ends.size() < num_groups && ends.back() > 1) {
    const std::size_t min = std::max(requested, ends.size() + 1) - ends.size();
    ends.push_back(std::max(ends.back() / 3 + 1, min));
  }
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::reverse(ends.begin(), ends.end());
  return ends;
}

void cut_components(std::size_t num_vertices, std::span<const std::size_t> ends,
                    std::span<const std::int32_t> residual, SharedRig& rig) {
  const std::size_t count = rig.trajectories.size();
  std::size_t first = 0;
  for (const std::size_t end : ends) {
    const std::size_t size = end - first;
    std::vector<std::int32_t> group_factors(num_vertices * size);
    for (std::size_t v = 0; v < num_vertices; ++v) {
      std::copy_n(&residual[v * count + first], size, &group_factors[v * size]);
    }
    rig.vertex_residual.push_back(std::move(group_factors));
    rig.group_end.push_back(kRestFactors + end);
    first = end;
  }
  rig.num_component_groups = static_cast<std::uint32_t>(ends.size());
}

}  // namespace

SliceCuts choose_slice_cuts(const SkinnedSettings& settings, double bits, std::size_t count) {
  std::size_t num_groups = settings.component_groups;
  SliceCuts cuts;
  cuts.num_layer_groups = settings.layer_groups;
  const double slices = bits / (8.0 * kBytesOfSlice);
  if (num_groups == 0) num_groups = slices < 4 ? 1 : slices < 12 ? 2 : slices < 24 ? 3 : 4;
  if (cuts.num_layer_groups == 0) cuts.num_layer_groups = slices < 6 ? 1 : slices < 16 ? 2 : 3;
  if (count > 0)
    cuts.group_end = component_group_ends(num_groups, settings.component_groups, count);
  return cuts;
}

void cut_slices(const OrderedMesh& mesh, const SkinnedSettings& settings, const SliceCuts& cuts,
                std::span<const std::int32_t> residual, SharedRig& rig) {
  rig.layer_group_size = layer_group_sizes(mesh, cuts.num_layer_groups, settings.layer_cuts);
  cut_components(mesh.num_vertices(), cuts.group_end, residual, rig);
  rig.slice_layers.assign(rig.group_end.size(),
                          static_cast<std::uint32_t>(rig.layer_group_size.size()));
}

}  // namespace rlpc
