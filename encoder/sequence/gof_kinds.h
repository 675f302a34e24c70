// The kinds of GOF that an encoder has.
#pragma once

#include "encoder/gof/gof_kind.h"

namespace rlpc {

// Those that profile and settings allow for, the likeliest first; at least one. Mesh and
// settings are kept by reference.
GofKinds make_gof_kinds(const SequenceMesh& mesh, const EncoderSettings& settings);

}  // namespace rlpc
