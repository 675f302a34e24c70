#include "decoder/report/slice_listing.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "common/syntax/stream_format.h"

namespace rlpc {
namespace {

enum class Heard : std::uint8_t {
  kUnitSize,
  kFirstFrame,
  kFrames,
  kClusters,
  kBones,
  kComponentGroups,
  kPrediction,
  kLayerGroups,
  kLayersOfGroup,
  kLayerStep,
  kComponentGroup,
  kLayerGroup,
  kScale,
};

const std::map<std::string_view, Heard>& names() {
  static const std::map<std::string_view, Heard> kNames{
      {"unit_size", Heard::kUnitSize},
      {"first_frame", Heard::kFirstFrame},
      {"num_gof_frames_minus1", Heard::kFrames},
      {"num_clusters_minus1", Heard::kClusters},
      {"num_bones_minus1", Heard::kBones},
      {"num_component_groups", Heard::kComponentGroups},
      {"prediction_idc", Heard::kPrediction},
      {"num_layer_groups_minus1", Heard::kLayerGroups},
      {"layer_group_layers_minus1", Heard::kLayersOfGroup},
      {"layer_step_minus1", Heard::kLayerStep},
      {"component_group_idx", Heard::kComponentGroup},
      {"layer_group_idx", Heard::kLayerGroup},
      {"scale_idx_delta", Heard::kScale},
  };
  return kNames;
}

}  // namespace

SliceTotals ListedGof::totals(const SliceGroups& groups) const {
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
SliceGroups ListedGof::groups_that_stay(const SliceCut& cut) const {
  SliceGroups groups{1, layer_groups_that_stay(layer_group_size, cut.max_layers)};
  std::uint64_t trajectories = 0;
  for (const SliceEntry& slice : slices) {
    trajectories += slice.num_trajectories;
    if (trajectories > cut.max_components) break;
    groups.component_groups = slice.component_group_idx + 1;
  }
  return groups;
}

void SliceListing::element(std::string_view name, std::int64_t value) {
  const auto heard = names().find(name);
  if (heard == names().end()) return;
  const auto number = static_cast<std::uint32_t>(value);
  if (heard->second == Heard::kUnitSize)
    unit_bytes_ = kUnitHeaderBytes + number + kUnitCrcBytes;
  if (heard->second == Heard::kFirstFrame) first_frame_ = number;
  if (heard->second == Heard::kFrames) num_frames_ = number + 1;
  if (heard->second == Heard::kClusters || heard->second == Heard::kBones) {
    gofs_.emplace_back();
    gofs_.back().first_frame = first_frame_;
    gofs_.back().num_frames = num_frames_;
    gofs_.back().bytes = unit_bytes_;
  }
  if (gofs_.empty()) return;
  ListedGof& gof = gofs_.back();
  std::vector<std::uint32_t>& groups = gof.layer_group_size;
  switch (heard->second) {
    case Heard::kClusters:
      gof.num_clusters = number + 1;
      break;
    case Heard::kBones:
      gof.num_bones = number + 1;
      break;
    case Heard::kComponentGroups:
      gof.num_component_groups = number;
      break;
    case Heard::kPrediction:
      gof.prediction_idc = number;
      break;
    case Heard::kLayerGroups:
      gof.num_layers = 0;
      groups.assign(1, 0);
      break;
    case Heard::kLayersOfGroup:
      groups.insert(groups.end() - 1, number + 1);
      break;
    case Heard::kLayerStep:
      // The last group has all layers that are left.
      gof.num_layers += 1;
      groups.back() =
          gof.num_layers -
          std::min(gof.num_layers, std::accumulate(groups.begin(), groups.end() - 1, 0U));
      break;
    case Heard::kComponentGroup:
      gof.slices.push_back({number, 0, 0, unit_bytes_});
      break;
    case Heard::kLayerGroup:
      gof.slices.back().layer_group_idx = number;
      break;
    case Heard::kScale:
      ++(gof.has_bones() ? gof.slices.back().num_trajectories : gof.num_components);
      break;
    default:
      break;
  }
}

}  // namespace rlpc
