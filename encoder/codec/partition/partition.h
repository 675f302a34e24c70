// Divides the vertices of an animated mesh into parts: clusters of the Baseline profile.
//
// Three methods are those that Ramanathan, Kassim and Tan (2008, section 2) compare; the fourth
// uses the motion.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// The part of each vertex. Parts are numbered by their lowest vertices; none is empty.
using Partition = std::vector<std::uint16_t>;

inline constexpr std::uint32_t kMaxParts = 1024;  // fixed: clusters of the highest level

// Makes at most `count` parts, 1 to kMaxParts; fewer if there are fewer vertices, or fewer that
// differ. Memory besides the frames is linear in the number of vertices.
//
//   method     not kSeeds
//   frames     at least one, with at least one vertex
//   triangles  none: a point cloud
Partition partition_vertices(PartitionMethod method, const SpanFrames& frames,
                             std::span<const Triangle> triangles, std::uint32_t count);

inline std::uint32_t num_parts(const Partition& partition) {
  std::uint32_t parts = 0;
  for (const std::uint16_t part : partition) parts = part >= parts ? part + 1U : parts;
  return parts;
}

// Numbers the parts as above.
void number_parts(Partition& partition);

}  // namespace rlpc
