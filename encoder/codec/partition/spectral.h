// Spectral clustering of the surface in the first frame (Liu and Zhang 2004; Ramanathan, Kassim
// and Tan 2008, 2.3): parts that meet where the surface is concave.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/partition/graph.h"
#include "encoder/codec/partition/partition.h"
#include "encoder/codec/partition/point_tree.h"

namespace rlpc {

// Divides the surface into parts; some part numbers may not occur. Affinities of all pairs of
// vertices would take too much time and memory, so those of a few hundred samples (twice as
// many as parts, if that is more) are used, and each vertex is in the part of its nearest
// sample.
//
//   graph  connected
//   count  1 to kMaxParts
Partition spectral_partition(const Graph& graph, std::span<const Point3> points,
                             std::span<const Triangle> triangles, std::uint32_t count);

}  // namespace rlpc
