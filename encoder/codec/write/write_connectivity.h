// 6.4 Connectivity, writing side.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

struct ConnectivityCode {
  std::vector<std::uint8_t> payload;
  std::vector<Triangle> triangles;          // decoded from the payload
  std::vector<std::uint32_t> input_vertex;  // [decoded vertex], index in the input
};

// 6.4.1 connectivity( ): codes any list of triangles with indices below num_vertices. Decoded
// triangles are the same, up to their order and the rotation of each.
ConnectivityCode write_connectivity(std::uint32_t num_vertices,
                                    std::span<const Triangle> triangles);

}  // namespace rlpc
