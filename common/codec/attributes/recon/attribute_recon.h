// Reconstructs attribute sets from seams and residuals (F.7.1).
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

// DecodeAttributes( ). triangles: in decoded order. first_frame: [num_vertices][3], in decoded
// order; may be empty if no set uses positions. Vertices of the result are in decoded order.
// Memory: proportional to triangles and vertices, one set at a time.
Vector<AttributeSet> recon_attributes(const CodedAttributes& coded, std::uint32_t num_vertices,
                                      std::span<const Triangle> triangles,
                                      std::span<const std::int32_t> first_frame);

}  // namespace rlpc
