#include "decoder/stream/gof_summary.h"

#include <variant>

namespace rlpc {
namespace {

template <class List>
std::uint32_t size_of(const List& list) {
  return static_cast<std::uint32_t>(list.size());
}

void add_kind(const ClusterGof& gof, GofSummary& summary) {
  std::size_t num_components = 0;
  for (const Cluster& cluster : gof.clusters) num_components += cluster.components.size();
  summary.figures = {{"num_clusters", "cluster", "clusters", size_of(gof.clusters)},
                     {"num_components", "component", "components",
                      static_cast<std::uint32_t>(num_components)}};
}

void add_kind(const SkinnedGof& gof, GofSummary& summary) {
  summary.layer_group_size = gof.layer_group_size;
  summary.figures = {
      {"num_bones", "bone", "bones", size_of(gof.bones)},
      {"num_trajectories", "trajectory", "trajectories", size_of(gof.trajectories)},
      {"num_component_groups", "component group", "component groups", gof.num_component_groups},
      {"prediction_idc", nullptr, nullptr, static_cast<std::uint32_t>(gof.prediction)},
      {"num_layers", "layer", "layers", size_of(gof.layer_step)},
      {"num_layer_groups", "layer group", "layer groups", size_of(gof.layer_group_size)},
      {"num_slices", "slice", "slices", size_of(summary.slices)}};
}

}  // namespace

std::uint32_t GofSummary::figure(std::string_view key) const {
  for (const GofFigure& f : figures) {
    if (key == f.key) return f.value;
  }
  return 0;
}

SliceTotals GofSummary::totals(const SliceGroups& groups) const {
  SliceTotals totals;
  totals.bytes = bytes;
  for (const SliceEntry& slice : slices) {
    if (!groups.have(slice)) continue;
    totals.num_slices += 1;
    totals.num_trajectories += slice.num_trajectories;
    totals.bytes += slice.bytes;
    if (slice.component_group_idx == 0) {
      totals.num_layers += layer_group_size[slice.layer_group_idx];
    }
  }
  return totals;
}

// 8.14.1 Slices that are absent
SliceGroups GofSummary::groups_that_stay(const SliceCut& cut) const {
  SliceGroups groups{1, layer_groups_that_stay(layer_group_size, cut.max_layers)};
  std::uint64_t trajectories = 0;
  for (const SliceEntry& slice : slices) {
    trajectories += slice.num_trajectories;
    if (trajectories > cut.max_components) break;
    groups.component_groups = slice.component_group_idx + 1;
  }
  return groups;
}

GofSummary summarise(const AccessUnit& access_unit) {
  const GofHeader& header = access_unit.header();
  GofSummary summary;
  summary.kind = header.kind;
  summary.first_frame = header.first_frame;
  summary.num_frames = header.num_frames;
  summary.bytes = access_unit.gof_bytes;
  summary.slices = access_unit.slices;
  std::visit([&](const auto& gof) { add_kind(gof, summary); }, access_unit.gof);
  return summary;
}

Result<std::vector<GofSummary>> summarise_all(StreamReader& stream) {
  std::vector<GofSummary> gofs;
  for (;;) {
    const auto access_unit = stream.next();
    if (!access_unit) return access_unit.error();
    if (!*access_unit) return gofs;
    gofs.push_back(summarise(**access_unit));
  }
}

}  // namespace rlpc
