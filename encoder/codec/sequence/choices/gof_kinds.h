// Lists the kinds of GOF of the encoder.
#pragma once

#include "encoder/codec/spans/kind_encoder.h"

namespace rlpc {

// Returns the kinds that profile and settings allow, the most likely first; at least one. Keeps
// references to mesh and settings.
KindEncoders make_gof_kinds(const SequenceMesh& mesh, const EncoderSettings& settings);

}  // namespace rlpc
