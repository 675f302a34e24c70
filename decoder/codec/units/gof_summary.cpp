#include "decoder/codec/units/gof_summary.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "common/memory/owned.h"

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

GofFigure temporal_layers_of(const SkinnedGof& gof) {
  return {"num_temporal_layers", "temporal layer", "temporal layers",
          static_cast<std::uint32_t>(gof.num_temporal_layers), true};
}

// Adds the rig of a skinned GOF or shared rig.
void add_rig(const SharedRig& rig, SlicedSummary& summary) {
  summary.layer_group_size = rig.layer_group_size;
  summary.first_group = "influences, rest positions";
  summary.figures = {
      {"num_bones", "bone", "bones", size_of(rig.bones)},
      {"num_trajectories", "trajectory", "trajectories", size_of(rig.trajectories)},
      {"num_component_groups", "component group", "component groups", rig.num_component_groups},
      {"prediction_idc", nullptr, nullptr, static_cast<std::uint32_t>(rig.prediction)},
      {"num_layers", "layer", "layers", size_of(rig.layer_step)},
      {"num_layer_groups", "layer group", "layer groups", size_of(rig.layer_group_size)},
      {"num_slices", "slice", "slices", size_of(summary.slices)}};
}

void add_kind(const SkinnedGof& gof, GofSummary& summary) {
  if (!gof.rig) {
    add_rig(gof, summary);
    summary.figures.push_back(temporal_layers_of(gof));
    return;
  }
  summary.layer_group_size = gof.layer_group_size;
  summary.figures = {
      {"num_trajectories", "trajectory", "trajectories", size_of(gof.trajectories)},
      {"num_local_groups", nullptr, nullptr, gof.num_local_groups},
      {"num_slices", "slice", "slices", size_of(summary.slices)},
      temporal_layers_of(gof)};
}

void add_kind(const InterGof& gof, GofSummary& summary) {
  const auto repeated = std::count_if(gof.frames->begin(), gof.frames->end(),
                                      [](const InterFrame& f) { return f.repeated; });
  summary.first_group = "frames";
  summary.layer_group_size = gof.layer_group_size;
  summary.figures = {
      {"frame_pattern_idc", nullptr, nullptr, gof.pattern.kind},
      {"pattern_period", nullptr, nullptr, gof.pattern.period()},
      {"exact_flag", nullptr, nullptr, gof.exact_flag ? 1U : 0U},
      {"learning_flag", nullptr, nullptr, gof.learning_flag ? 1U : 0U},
      {"num_temporal_layers", "temporal layer", "temporal layers", gof.pattern.temporal_layers,
       true},
      {"num_layers", "layer", "layers", size_of(gof.layer_step)},
      {"num_layer_groups", "layer group", "layer groups", size_of(gof.layer_group_size)},
      {"num_frame_units", "frame unit", "frame units", size_of(summary.slices)},
      {"num_repeated_frames", "repeated frame", "repeated frames",
       static_cast<std::uint32_t>(repeated), true},
      {"num_patches", "patch", "patches", gof.num_patches, true}};
  summary.vertex_modes = vertex_modes(gof);
}

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

GofSummary summary_of(const AccessUnit& access_unit) {
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

// Collects summaries, and tracks the shared rigs alive.
class Summariser {
 public:
  void add(const ParsedRig& parsed) {
    const auto rig = make_shared_owned<RigSummary>();
    rig->number = summary_.rigs.size();
    rig->rig_idx = parsed.rig_idx;
    rig->num_component_groups = parsed.rig->num_component_groups;
    rig->bytes = parsed.bytes;
    rig->slices = parsed.slices;
    add_rig(*parsed.rig, *rig);
    of_idx_[parsed.rig_idx] = rig;
    summary_.rigs.push_back(rig);
  }
  void add(const AccessUnit& access_unit) {
    GofSummary gof = summary_of(access_unit);
    const auto* skinned = std::get_if<SkinnedGof>(&access_unit.gof);
    if (skinned != nullptr && skinned->rig) {
      const auto& rig = of_idx_[skinned->rig_idx];
      ++rig->num_gofs;
      gof.rig = rig;
    }
    summary_.gofs.push_back(std::move(gof));
  }
  StreamSummary finish() { return std::move(summary_); }

 private:
  StreamSummary summary_;
  std::array<std::shared_ptr<RigSummary>, kMaxRigs> of_idx_;
};

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

Result<StreamSummary> summarise_all(StreamReader& stream, const CheckAccessUnit& check) {
  Summariser summariser;
  stream.rigs().watch([&](const ParsedRig& rig) { summariser.add(rig); });
  for (;;) {
    const auto access_unit = stream.next();
    if (!access_unit || !*access_unit) stream.rigs().watch({});
    if (!access_unit) return access_unit.error();
    if (!*access_unit) return summariser.finish();
    summariser.add(**access_unit);
    if (!check) continue;
    if (const auto error = check(**access_unit)) {
      stream.rigs().watch({});
      return *error;
    }
  }
}

}  // namespace rlpc
