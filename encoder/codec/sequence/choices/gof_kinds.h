// Lists the kinds of GOF of the encoder.
#pragma once

#include "encoder/codec/spans/gof_kind.h"

namespace rlpc {

// The kinds that profile and settings allow, the most likely first; at least one. Keeps
// references to mesh and settings.
GofKinds make_gof_kinds(const SequenceMesh& mesh, const EncoderSettings& settings);

}  // namespace rlpc
