// What rlpcinfo tells of GOFs: clusters and components, or bones, trajectories and slices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/bitstream/trace.h"
#include "decoder/slice_cut.h"

namespace rlpc {

struct SliceEntry {
  std::uint32_t component_group_idx = 0;
  std::uint32_t layer_group_idx = 0;
  std::uint32_t num_trajectories = 0;  // whose temporal values are in it
  std::uint64_t bytes = 0;             // of the unit
};

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

struct ListedGof {
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

  bool has_bones() const { return num_bones > 0; }
  std::uint32_t num_trajectories() const { return totals({}).num_trajectories; }
  SliceTotals totals(const SliceGroups& groups) const;
  SliceGroups groups_that_stay(const SliceCut& cut) const;
};

// Listens to a trace, and makes a list of it.
class SliceListing {
 public:
  void element(std::string_view name, std::int64_t value);
  // Once all elements were heard.
  const std::vector<ListedGof>& gofs() const { return gofs_; }

 private:
  std::vector<ListedGof> gofs_;
  std::uint64_t unit_bytes_ = 0;
  std::uint32_t first_frame_ = 0;
  std::uint32_t num_frames_ = 0;
};

// A trace that only lists.
class ListingTrace final : public Trace {
 public:
  void begin(const char*, std::uint64_t) override {}
  void element(const char* name, std::int64_t value, std::uint64_t) override {
    listing_.element(name, value);
  }
  const std::vector<ListedGof>& gofs() const { return listing_.gofs(); }

 private:
  SliceListing listing_;
};

}  // namespace rlpc
