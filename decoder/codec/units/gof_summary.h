// Summarises GOFs and shared rigs in numbers: clusters and components, or bones,
// trajectories and slices.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "common/codec/kinds/access_unit.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/slice_cut.h"
#include "decoder/codec/units/stream_reader.h"
#include "decoder/codec/units/vertex_modes.h"

namespace rlpc {

// The leading component groups of a GOF or shared rig, including that of the rest positions,
// its leading layer groups, and its first temporal layers.
struct SliceGroups {
  std::uint32_t component_groups = SliceCut::kAll;
  std::uint32_t layer_groups = SliceCut::kAll;
  std::uint32_t temporal_layers = SliceCut::kAll;

  bool have(const SliceEntry& slice) const {
    return slice.component_group_idx < component_groups &&
           slice.layer_group_idx < layer_groups && slice.temporal_layer_idx < temporal_layers;
  }
};

// Totals within such groups.
struct SliceTotals {
  std::size_t num_slices = 0;
  std::uint32_t num_trajectories = 0;
  std::uint32_t num_layers = 0;  // layers with residuals of rest positions
  std::uint32_t num_temporal_layers = 1;
  std::uint64_t bytes = 0;  // of the GOF or rig unit and of slice units
};

// A number that describes a GOF. one, many: the noun, singular and plural; null: only shown in
// JSON. only_many: shown in JSON, and elsewhere if it is greater than 1.
struct GofFigure {
  const char* key = nullptr;  // in JSON
  const char* one = nullptr;
  const char* many = nullptr;
  std::uint32_t value = 0;
  bool only_many = false;
};

// A GOF or shared rig.
struct SlicedSummary {
  std::uint64_t bytes = 0;  // of its unit

  Vector<GofFigure> figures;  // the same keys for each GOF of a kind

  // 0 if the kind lacks the key.
  std::uint32_t figure(std::string_view key) const;

  // Of kinds that have slices.
  Vector<std::uint32_t> layer_group_size{1};  // [num_layer_groups] layers
  Vector<SliceEntry> slices;                  // or frame units
  const char* first_group = nullptr;          // what component group 0 has

  // The same, with those that differ only in their frames taken together.
  Vector<SliceEntry> slices_by_group() const;
  // Component groups up to the last that has a slice, including that of the rest positions.
  std::uint32_t num_groups() const;
  // Temporal layers up to the last that has a slice.
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
  std::size_t number = 0;  // among those of the stream, counted from 0
  std::uint32_t rig_idx = 0;
  std::uint32_t num_component_groups = 0;
  std::uint32_t num_gofs = 0;  // that use it

  SliceGroups groups_that_stay(const SliceCut& cut) const;
  bool is_cut_by(const SliceCut& cut) const;
};

struct GofSummary : SlicedSummary {
  GofKind kind = GofKind::kCluster;
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;
  std::shared_ptr<const RigSummary> rig;  // that it uses; null: none
  Vector<VertexModes> vertex_modes;       // [num_frames] if it has patches

  // Bytes and slices are its own; layers are those of its shared rig.
  SliceTotals totals(const SliceGroups& groups) const;
  SliceGroups groups_that_stay(const SliceCut& cut) const;
  // Whether the GOF or its shared rig loses a slice.
  bool is_cut_by(const SliceCut& cut) const;
};

struct StreamSummary {
  Vector<std::shared_ptr<const RigSummary>> rigs;  // in the order of the stream
  Vector<GofSummary> gofs;

  std::uint32_t num_frames() const {
    return gofs.empty() ? 0 : gofs.back().first_frame + gofs.back().num_frames;
  }
};

// Summaries of all GOFs and shared rigs of a stream, which is read to its end. `check` is
// called with each access unit, and can end it with an error.
using CheckAccessUnit = std::function<std::optional<Error>(const AccessUnit&)>;
Result<StreamSummary> summarise_all(StreamReader& stream, const CheckAccessUnit& check = {});

}  // namespace rlpc
