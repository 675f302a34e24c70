// Registers inter GOFs as a kind of GOF (clauses 6.14 and 8.19).
#pragma once

#include <memory>

#include "encoder/codec/spans/kind_encoder.h"

namespace rlpc {

// Returns null below the High profile, or if the settings exclude inter GOFs.
std::unique_ptr<KindEncoder> make_inter_gof_kind(const SequenceMesh& mesh,
                                                 const EncoderSettings& settings);

}  // namespace rlpc
