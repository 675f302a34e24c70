#include "encoder/skinned_gof/quantise/slice_cuts.h"

#include <algorithm>
#include <vector>

namespace rlpc {
namespace {

constexpr double kBytesOfSlice = 4000.0;  // fixed: slices are a feature; they cost 0.2 %

// The layers before each group have at most an eighth of the vertices of all layers up to its
// end. A group is smaller if it would not leave enough layers for the requested number of
// groups.
void cut_layers(const CodedMesh& mesh, std::size_t num_groups, std::uint32_t requested,
                SkinnedModel& model) {
  const std::uint32_t num_layers = mesh.num_layers();
  requested = std::min(requested, num_layers);
  std::vector<std::uint32_t> ends{num_layers};
  for (std::uint32_t last = num_layers; ends.size() < num_groups; ends.push_back(last)) {
    const std::size_t most = mesh.vertices_of_layers(0, last).size() / 8;
    const auto num_ends = static_cast<std::uint32_t>(ends.size());
    const std::uint32_t first = std::max(requested, num_ends + 1) - num_ends;
    while (last > first && mesh.vertices_of_layers(0, last).size() > most) --last;
    if (last == ends.back()) break;
  }
  model.layer_group_size.clear();
  std::uint32_t first = 0;
  for (std::size_t i = ends.size(); i-- > 0;) {
    model.layer_group_size.push_back(ends[i] - first);
    first = ends[i];
  }
}

// The trajectories up to the end of each group are about three times as many as those before
// it. A group is smaller if it would not leave enough trajectories for the requested number of
// groups.
std::vector<std::size_t> component_group_ends(std::size_t num_groups, std::size_t requested,
                                              std::size_t count) {
  requested = std::min(requested, count);
  std::vector<std::size_t> ends{count};
  while (ends.size() < num_groups && ends.back() > 1) {
    const std::size_t least = std::max(requested, ends.size() + 1) - ends.size();
    ends.push_back(std::max(ends.back() / 3 + 1, least));
  }
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::reverse(ends.begin(), ends.end());
  return ends;
}

void cut_components(std::size_t num_vertices, std::span<const std::size_t> ends,
                    std::span<const std::int32_t> residual, SkinnedModel& model) {
  const std::size_t count = model.trajectories.size();
  std::size_t first = 0;
  for (const std::size_t end : ends) {
    const std::size_t size = end - first;
    std::vector<std::int32_t> of_group(num_vertices * size);
    for (std::size_t v = 0; v < num_vertices; ++v) {
      std::copy_n(&residual[v * count + first], size, &of_group[v * size]);
    }
    model.vertex_residual.push_back(std::move(of_group));
    model.group_end.push_back(kRestFactors + end);
    first = end;
  }
  model.num_component_groups = static_cast<std::uint32_t>(ends.size());
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

void cut_slices(const CodedMesh& mesh, const SkinnedSettings& settings, const SliceCuts& cuts,
                std::span<const std::int32_t> residual, SkinnedModel& model) {
  cut_layers(mesh, cuts.num_layer_groups, settings.layer_groups, model);
  cut_components(mesh.num_vertices(), cuts.group_end, residual, model);
  model.slice_layers.assign(model.group_end.size(),
                            static_cast<std::uint32_t>(model.layer_group_size.size()));
}

}  // namespace rlpc
