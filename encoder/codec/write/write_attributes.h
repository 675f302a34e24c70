// Attribute units (Annex F), writing side.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/mesh.h"

namespace rlpc {

// F.2.1 attributes( ): returns the payload of an attribute unit. triangles: in decoded order.
std::vector<std::uint8_t> write_attributes(const CodedAttributes& coded,
                                           std::uint32_t num_vertices,
                                           std::span<const Triangle> triangles);

}  // namespace rlpc
