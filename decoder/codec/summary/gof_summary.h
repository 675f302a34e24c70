// Summaries of GOFs and shared rigs in numbers: clusters and components, or bones, trajectories
// and slices.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "common/codec/kinds/access_unit.h"
#include "common/memory/owned.h"
#include "decoder/codec/slice_cut.h"

namespace rlpc {

// Numbers of leading component groups, including the group of the rest positions, leading layer
// groups and first temporal layers of a GOF or shared rig.
struct SliceGroups {
  std::uint32_t component_groups = SliceCut::kAll;
  std::uint32_t layer_groups = SliceCut::kAll;
  std::uint32_t temporal_layers = SliceCut::kAll;

  bool have(const SliceEntry& slice) const {
    return slice.component_group_idx < component_groups &&
           slice.layer_group_idx < layer_groups && slice.temporal_layer_idx < temporal_layers;
  }
};

// Totals within SliceGroups.
struct SliceTotals {
  std::size_t num_slices = 0;
  std::uint32_t num_trajectories = 0;
  std::uint32_t num_layers = 0;  // layers with residuals of rest positions
  std::uint32_t num_temporal_layers = 1;
  std::uint64_t bytes = 0;  // GOF or rig unit and slice units
};

// Number that describes a GOF. one, many: its noun, singular and plural; null: shown only in
// JSON. only_many: elsewhere than in JSON, shown only if greater than 1.
struct GofFigure {
  const char* key = nullptr;  // in JSON
  const char* one = nullptr;
  const char* many = nullptr;
  std::uint32_t value = 0;
  bool only_many = false;
};

// Numbers of the vertices of one frame that follow the motion of their patch or not (8.19.5).
// All are 0 if the frame repeats another.
struct VertexModes {
  std::uint32_t from_neighbours = 0;
  std::uint32_t with_residuals = 0;     // follow the motion of their patch, with residuals
  std::uint32_t without_residuals = 0;  // follow it in a patch without residuals, or all are 0

  bool operator==(const VertexModes&) const = default;
};

template <class List>
std::uint32_t count_of(const List& list) {
  return static_cast<std::uint32_t>(list.size());
}

// Summary of a GOF or shared rig.
struct SlicedSummary {
  std::uint64_t bytes = 0;  // its GOF or rig unit

  Vector<GofFigure> figures;  // the same keys for each GOF of a kind

  // Returns a figure; 0 if the kind lacks the key.
  std::uint32_t figure(std::string_view key) const;

  // Groups and slices, in kinds that have them.
  Vector<std::uint32_t> layer_group_size{1};  // [num_layer_groups] layers
  Vector<SliceEntry> slices;                  // or frame units
  const char* first_group = nullptr;          // contents of component group 0, for people

  // Returns the slices, with slices that differ only in their frames combined.
  Vector<SliceEntry> slices_by_group() const;
  // Returns the component groups up to the last one with a slice, including the group of the
  // rest positions.
  std::uint32_t num_groups() const;
  // Returns the temporal layers up to the last one with a slice.
  std::uint32_t num_temporal_layers() const {
    std::uint32_t layers = 1;
    for (const SliceEntry& slice : slices) {
      layers = std::max(layers, slice.temporal_layer_idx + 1);
    }
    return layers;
  }
  SliceTotals totals(const SliceGroups& groups) const;
};

struct RigSummary : SlicedSummary {
  std::size_t number = 0;  // index among the rigs of the stream
  std::uint32_t rig_idx = 0;
  std::uint32_t num_component_groups = 0;
  std::uint32_t num_gofs = 0;  // number of GOFs that use it

  SliceGroups groups_that_stay(const SliceCut& cut) const;
  bool is_cut_by(const SliceCut& cut) const;
};

struct GofSummary : SlicedSummary {
  GofKind kind = GofKind::kCluster;
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;
  std::shared_ptr<const RigSummary> rig;  // shared rig in use; null: none
  Vector<VertexModes> vertex_modes;       // [num_frames] if it has patches

  // Returns totals: bytes and slices of the GOF, layers of its shared rig.
  SliceTotals totals(const SliceGroups& groups) const;
  SliceGroups groups_that_stay(const SliceCut& cut) const;
  // Returns whether the GOF or its shared rig loses a slice.
  bool is_cut_by(const SliceCut& cut) const;
};

}  // namespace rlpc
