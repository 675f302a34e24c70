// Lloyd's algorithm (1982) for points of any dimension.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "encoder/codec/partition/partition.h"

namespace rlpc {

// Finds the nearest of up to `count` centres for each point, the first of equally near ones.
// The centres start far from each other: the first is the point farthest from the mean of all
// points, each further one the point farthest from those before. There are fewer centres if
// fewer points differ, and some may end without points.
//
//   points  [num_points][dimensions]
//   count   1 to kMaxParts
Partition k_means(std::span<const double> points, std::size_t dimensions, std::uint32_t count);

}  // namespace rlpc
