// Summarises a GOF in numbers: clusters and components, or bones, trajectories and slices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/result.h"
#include "common/syntax/access_unit.h"
#include "decoder/slice_cut.h"
#include "decoder/stream/stream_reader.h"

namespace rlpc {

// The leading component groups of a GOF, including that of the rest positions, and its leading
// layer groups.
struct SliceGroups {
  std::uint32_t component_groups = SliceCut::kAll;
  std::uint32_t layer_groups = SliceCut::kAll;

  bool have(const SliceEntry& slice) const {
    return slice.component_group_idx < component_groups && slice.layer_group_idx < layer_groups;
  }
};

// Totals of a GOF within such groups.
struct SliceTotals {
  std::size_t num_slices = 0;
  std::uint32_t num_trajectories = 0;
  std::uint32_t num_layers = 0;  // layers with residuals of rest positions
  std::uint64_t bytes = 0;       // of the GOF unit and of slice units
};

// A number that describes a GOF. one, many: the noun, singular and plural; null: only shown in
// JSON.
struct GofFigure {
  const char* key;  // in JSON
  const char* one;
  const char* many;
  std::uint32_t value;
};

struct GofSummary {
  GofKind kind = GofKind::kClusters;
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;
  std::uint64_t bytes = 0;  // of the GOF unit

  std::vector<GofFigure> figures;  // the same keys for each GOF of a kind

  // 0 if the kind lacks the key.
  std::uint32_t figure(std::string_view key) const;

  // Of kinds that have slices.
  std::vector<std::uint32_t> layer_group_size{1};  // [num_layer_groups] layers
  std::vector<SliceEntry> slices;

  SliceTotals totals(const SliceGroups& groups) const;
  SliceGroups groups_that_stay(const SliceCut& cut) const;
};

GofSummary summarise(const AccessUnit& access_unit);

// Summaries of all GOFs of a stream, which is read to its end.
Result<std::vector<GofSummary>> summarise_all(StreamReader& stream);

}  // namespace rlpc
