// Lloyd's k-means clustering of vertices (Ramanathan, Kassim and Tan 2008, 2.2).
#pragma once

#include <cstdint>
#include <span>

#include "encoder/codec/partition/partition.h"
#include "encoder/codec/partition/point_tree.h"

namespace rlpc {

// Makes parts of points that are near each other, whatever the edges. Some part numbers may not
// occur.
//
//   count  1 to kMaxParts
Partition lloyd_partition(std::span<const Point3> points, std::uint32_t count);

}  // namespace rlpc
