// Cluster GOFs (clauses 6.5 and 8.4 to 8.6).
#pragma once

#include <memory>

#include "encoder/gof/gof_kind.h"

namespace rlpc {

std::unique_ptr<GofEncoder> make_cluster_gof_kind(const SequenceMesh& mesh,
                                                  const EncoderSettings& settings);

// In the Main profile, whatever the preset and the target, for targets that other kinds fail.
// Null where the settings ask for bones.
std::unique_ptr<GofEncoder> make_last_resort(const SequenceMesh& mesh,
                                             const EncoderSettings& settings);

}  // namespace rlpc
