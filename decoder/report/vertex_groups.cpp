#include "decoder/report/vertex_groups.h"

#include "decoder/codec/kinds/kinds.h"

namespace rlpc {

VertexGroups vertex_groups(const AccessUnit& access_unit, const StreamContext& context) {
  VertexGroups groups;
  groups.first_frame = access_unit.header().first_frame;
  groups.num_frames = access_unit.header().num_frames;
  visit_gof(access_unit.gof,
            [&](auto decoder, const auto& gof) { decoder.add_groups(gof, context, groups); });
  return groups;
}

}  // namespace rlpc
