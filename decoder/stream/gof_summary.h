// What is in a GOF, in numbers: clusters and components, or bones, trajectories and slices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/result.h"
#include "common/syntax/access_unit.h"
#include "decoder/slice_cut.h"
#include "decoder/stream/stream_reader.h"

namespace rlpc {

// Of a GOF: its first component groups, with that of the rest positions, and its first layer
// groups.
struct SliceGroups {
  std::uint32_t component_groups = SliceCut::kAll;
  std::uint32_t layer_groups = SliceCut::kAll;

  bool have(const SliceEntry& slice) const {
    return slice.component_group_idx < component_groups && slice.layer_group_idx < layer_groups;
  }
};

// What there is of a GOF within such groups.
struct SliceTotals {
  std::size_t num_slices = 0;
  std::uint32_t num_trajectories = 0;
  std::uint32_t num_layers = 0;  // in which vertices have residuals of rest positions
  std::uint64_t bytes = 0;       // of the GOF unit and of slice units
};

struct GofSummary {
  GofKind kind = GofKind::kClusters;
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;
  std::uint64_t bytes = 0;  // of the GOF unit

  // Of a GOF of clusters; it has nothing of what follows.
  std::uint32_t num_clusters = 0;
  std::uint32_t num_components = 0;  // of all clusters

  std::uint32_t num_bones = 0;
  std::uint32_t prediction_idc = 0;
  std::uint32_t num_component_groups = 0;
  std::uint32_t num_layers = 1;
  std::vector<std::uint32_t> layer_group_size{1};  // [num_layer_groups] layers
  std::vector<SliceEntry> slices;

  bool has_bones() const { return kind == GofKind::kSkinned; }
  std::uint32_t num_trajectories() const { return totals({}).num_trajectories; }
  SliceTotals totals(const SliceGroups& groups) const;
  SliceGroups groups_that_stay(const SliceCut& cut) const;
};

GofSummary summarise(const AccessUnit& access_unit);

// Those of all GOFs of a stream, which is read to its end.
Result<std::vector<GofSummary>> summarise_all(StreamReader& stream);

}  // namespace rlpc
