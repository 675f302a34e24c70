// GOFs as skinned meshes: bones, and trajectories of what they leave (clauses 6.11, 6.12 and
// 8.9 to 8.14).
#pragma once

#include <memory>

#include "encoder/gof/gof_kind.h"

namespace rlpc {

std::unique_ptr<GofEncoder> make_skinned_gof_kind(const SequenceMesh& mesh,
                                                  const EncoderSettings& settings);

}  // namespace rlpc
