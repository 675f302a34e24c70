// 8.14.1 Slices that are absent: selects the slices to drop from each GOF.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace rlpc {

// Keeps or drops component groups and layer groups as a whole: each GOF keeps the leading
// component groups with at most max_components trajectories in total, the coarsest layer groups
// with at most max_layers vertex layers in total, and the first max_temporal_layers temporal
// layers. The first layer group, influences and rest positions are always kept.
struct SliceCut {
  static constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t max_components = kAll;
  std::uint32_t max_layers = kAll;
  std::uint32_t max_temporal_layers = kAll;  // at least 1
  // Layer groups with none of the coarsest needed_layers vertex layers are dropped (8.9.8).
  std::uint32_t needed_layers = kAll;  // at least 1

  static constexpr const char* kNoSlices =
      "a stream of the Baseline profile has no slices, and cannot be cut";
  bool cuts() const {
    return max_components != kAll || max_layers != kAll || max_temporal_layers != kAll ||
           needed_layers != kAll;
  }
};

// Returns the number of leading layer groups within a cut. layer_group_size: layers of each
// group, at least one group.
inline std::uint32_t layer_groups_that_stay(std::span<const std::uint32_t> layer_group_size,
                                            const SliceCut& cut) {
  std::uint64_t layers = layer_group_size[0];
  std::size_t groups = 1;
  while (groups < layer_group_size.size() && layers < cut.needed_layers) {
    layers += layer_group_size[groups];
    if (layers > cut.max_layers) break;
    ++groups;
  }
  return static_cast<std::uint32_t>(groups);
}

}  // namespace rlpc
