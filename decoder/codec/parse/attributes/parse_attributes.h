// Attribute units (Annex F), parsing side.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/bits/bit_reader.h"
#include "common/codec/mesh/mesh.h"
#include "common/result.h"
#include "decoder/codec/parse/memory_limit.h"

namespace rlpc {

// F.2.1 attributes( ). triangles: in decoded order. Names are not checked (R-ATT-09). Fails if
// a set needs more memory than is allowed.
Result<CodedAttributes> parse_attributes(BitReader& r, std::uint32_t num_vertices,
                                         std::span<const Triangle> triangles,
                                         const MemoryLimit& memory);

// Returns whether decoding an attribute unit needs the first frame. Reads only its headers;
// false if they do not conform.
bool attributes_use_positions(BitReader& r);

}  // namespace rlpc
