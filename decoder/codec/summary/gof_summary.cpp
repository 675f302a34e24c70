#include "decoder/codec/summary/gof_summary.h"

#include <algorithm>

namespace rlpc {
namespace {

// 8.14.1 Slices that are absent: adds the groups of `slices` to the groups that stay.
// trajectories: number in the groups before.
void add_groups(const Vector<SliceEntry>& slices, const SliceCut& cut,
                std::uint64_t trajectories, SliceGroups& groups) {
  for (const SliceEntry& slice : slices) {
    if (slice.component_group_idx < groups.component_groups) continue;
    trajectories += slice.num_trajectories;
    if (trajectories > cut.max_components) break;
    groups.component_groups = slice.component_group_idx + 1;
  }
}

}  // namespace

std::uint32_t SlicedSummary::figure(std::string_view key) const {
  for (const GofFigure& f : figures) {
    if (key == f.key) return f.value;
  }
  return 0;
}

std::uint32_t SlicedSummary::num_groups() const {
  std::uint32_t groups = 0;
  for (const SliceEntry& slice : slices) {
    groups = std::max(groups, slice.component_group_idx + 1);
  }
  return groups;
}

Vector<SliceEntry> SlicedSummary::slices_by_group() const {
  Vector<SliceEntry> groups;
  for (const SliceEntry& slice : slices) {
    const auto is_same = [&](const SliceEntry& other) {
      return other.component_group_idx == slice.component_group_idx &&
             other.layer_group_idx == slice.layer_group_idx &&
             other.temporal_layer_idx == slice.temporal_layer_idx;
    };
    const auto found = slice.frame_idx == 0
                           ? groups.end()
                           : std::find_if(groups.begin(), groups.end(), is_same);
    if (found == groups.end()) {
      groups.push_back(slice);
    } else {
      found->bytes += slice.bytes;
    }
  }
  return groups;
}

SliceTotals SlicedSummary::totals(const SliceGroups& groups) const {
  SliceTotals totals;
  totals.bytes = bytes;
  for (const SliceEntry& slice : slices) {
    if (!groups.have(slice)) continue;
    totals.num_slices += 1;
    totals.num_trajectories += slice.num_trajectories;
    totals.bytes += slice.bytes;
    totals.num_temporal_layers =
        std::max(totals.num_temporal_layers, slice.temporal_layer_idx + 1);
    if (slice.component_group_idx == 0 && slice.temporal_layer_idx == 0 &&
        slice.frame_idx == 0) {
      totals.num_layers += layer_group_size[slice.layer_group_idx];
    }
  }
  return totals;
}

SliceGroups RigSummary::groups_that_stay(const SliceCut& cut) const {
  SliceGroups groups{1, layer_groups_that_stay(layer_group_size, cut)};
  add_groups(slices, cut, 0, groups);
  return groups;
}

bool RigSummary::is_cut_by(const SliceCut& cut) const {
  return totals(groups_that_stay(cut)).num_slices < slices.size();
}

SliceTotals GofSummary::totals(const SliceGroups& groups) const {
  SliceTotals totals = SlicedSummary::totals(groups);
  if (rig) totals.num_layers = rig->totals(groups).num_layers;
  return totals;
}

// Local component groups follow the groups of a complete shared rig.
SliceGroups GofSummary::groups_that_stay(const SliceCut& cut) const {
  SliceGroups groups{1, layer_groups_that_stay(layer_group_size, cut)};
  std::uint64_t trajectories = 0;
  if (rig) groups = rig->groups_that_stay(cut);
  groups.temporal_layers = cut.max_temporal_layers;
  if (rig) {
    if (groups.component_groups <= rig->num_component_groups) return groups;
    trajectories = rig->totals(groups).num_trajectories;
  }
  add_groups(slices, cut, trajectories, groups);
  return groups;
}

bool GofSummary::is_cut_by(const SliceCut& cut) const {
  return totals(groups_that_stay(cut)).num_slices < slices.size() ||
         (rig && rig->is_cut_by(cut));
}

}  // namespace rlpc
