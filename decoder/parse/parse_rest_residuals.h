// 6.12.4 Rest residuals of a vertex, parsing side.
#pragma once

#include "common/mesh/rest_order.h"
#include "common/skinned_gof/skinned_gof.h"
#include "common/skinned_gof/slice_models.h"
#include "decoder/parse/section_reader.h"

namespace rlpc {

// rest_residuals( v ) of all vertices, in their order: the residuals of component group 0 and
// the counterparts of the model, which have their size already. Errors are left in the section.
void parse_rest_residuals(SectionReader& section, const RestOrder& order, VertexModels& models,
                          SkinnedModel& model);

}  // namespace rlpc
