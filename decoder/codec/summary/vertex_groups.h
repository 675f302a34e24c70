// Groups of the vertices of a GOF for pictures: its clusters, bones or patches.
#pragma once

#include <array>
#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

enum class GroupKind : std::uint8_t { kNone, kClusters, kBones, kPatches };

struct VertexGroups {
  GroupKind kind = GroupKind::kNone;  // kNone: an inter GOF without patches
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;
  std::uint32_t num_groups = 0;
  // [num_vertices], in decoded order: the first cluster that a seed vertex seeds; the first
  // bone with the greatest weight.
  Vector<std::uint32_t> group_of_vertex;
  // Vertices of the seed triangles of clusters that have one, in the order of clusters.
  Vector<std::array<std::uint32_t, 3>> seeds;
};

}  // namespace rlpc
