// Maps the corners of the decoded triangles, which have another order, to those of the input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/codec/write/write_connectivity.h"

namespace rlpc {

// Returns [decoded corner]: the corner of the input, both 3 * triangle + k. input: the
// triangles that the connectivity was made from.
std::vector<std::uint32_t> map_corners(const ConnectivityCode& connectivity,
                                       std::span<const Triangle> input);

}  // namespace rlpc
