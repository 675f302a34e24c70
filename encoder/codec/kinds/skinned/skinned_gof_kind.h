// Registers skinned GOFs as a kind of GOF: bones, and trajectories for the residual of bone
// motion (clauses 6.11, 6.12 and 8.9 to 8.14).
#pragma once

#include <memory>

#include "encoder/codec/spans/kind_encoder.h"

namespace rlpc {

// Returns null for the Baseline profile.
std::unique_ptr<KindEncoder> make_skinned_gof_kind(const SequenceMesh& mesh,
                                                   const EncoderSettings& settings);

}  // namespace rlpc
