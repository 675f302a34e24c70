// Registers cluster GOFs as a kind of GOF (clauses 6.5 and 8.4 to 8.6).
#pragma once

#include <memory>

#include "encoder/codec/spans/kind_encoder.h"

namespace rlpc {

// Returns cluster GOFs as one of the kinds to compare; null if the settings exclude them.
std::unique_ptr<KindEncoder> make_cluster_gof_kind(const SequenceMesh& mesh,
                                                   const EncoderSettings& settings);

// Returns cluster GOFs for the Main profile if the other kinds miss the target, whatever the
// preset and the target; null for the Baseline profile, and if the settings require skinned
// GOFs.
std::unique_ptr<KindEncoder> make_last_resort(const SequenceMesh& mesh,
                                              const EncoderSettings& settings);

}  // namespace rlpc
