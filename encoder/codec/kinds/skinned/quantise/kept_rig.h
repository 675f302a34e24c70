// Shared rig that later spans may use, exactly as it was coded.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

struct KeptRig {
  std::shared_ptr<const SharedRig> rig;  // has no residuals of vertices
  std::shared_ptr<const RigRecon> recon;
  std::array<std::vector<std::int32_t>, 3> rest;  // rest positions, 1/16 grid units
};

}  // namespace rlpc
