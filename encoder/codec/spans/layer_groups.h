// Divides vertex layers into groups, which a sub-stream extractor can drop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/ordered_mesh.h"

namespace rlpc {

// Returns the number of layers of each of so many groups, at most one per layer. Without cuts,
// numbers of vertices up to the ends of groups grow by equal factors, from an eighth of the
// mesh to all of it.
//
//   cuts  wanted numbers of vertices up to the end of each group but the last, ascending, or
//         empty; the nearest layer ends the group
std::vector<std::uint32_t> layer_group_sizes(const OrderedMesh& mesh, std::size_t num_groups,
                                             std::span<const std::uint32_t> cuts = {});

}  // namespace rlpc
