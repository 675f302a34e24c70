// Groups of the vertices of a GOF of any kind.
#pragma once

#include "common/codec/kinds/access_unit.h"
#include "common/codec/syntax/stream_context.h"
#include "decoder/codec/summary/vertex_groups.h"

namespace rlpc {

VertexGroups vertex_groups(const AccessUnit& access_unit, const StreamContext& context);

}  // namespace rlpc
