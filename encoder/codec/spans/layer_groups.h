// Divides vertex layers into groups, which a sub-stream extractor can drop.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/mesh/ordered_mesh.h"

namespace rlpc {

// Returns the number of layers of each of at most num_groups groups. The layers before each
// group have at most an eighth of the vertices of all layers up to its end. A group is smaller
// if it would not leave enough layers for the requested number of groups.
inline std::vector<std::uint32_t> layer_group_sizes(const OrderedMesh& mesh,
                                                    std::size_t num_groups,
                                                    std::uint32_t requested) {
  const std::uint32_t num_layers = mesh.num_layers();
  requested = std::min(requested, num_layers);
  std::vector<std::uint32_t> ends{num_layers};
  for (std::uint32_t last = num_layers; ends.size() < num_groups; ends.push_back(last)) {
    const std::size_t max = mesh.vertices_of_layers(0, last).size() / 8;
    const auto num_ends = static_cast<std::uint32_t>(ends.size());
    const std::uint32_t first = std::max(requested, num_ends + 1) - num_ends;
    while (last > first && mesh.vertices_of_layers(0, last).size() > max) --last;
    if (last == ends.back()) break;
  }
  std::vector<std::uint32_t> sizes;
  std::uint32_t first = 0;
  for (std::size_t i = ends.size(); i-- > 0;) {
    sizes.push_back(ends[i] - first);
    first = ends[i];
  }
  return sizes;
}

}  // namespace rlpc
