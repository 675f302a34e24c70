// A skinned model that later spans may use, exactly as it was coded.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/codec/kinds/skinned/recon/model_recon.h"
#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

struct KeptModel {
  std::shared_ptr<const SkinnedModel> model;  // without residuals of vertices
  std::shared_ptr<const ModelRecon> recon;
  std::array<std::vector<std::int32_t>, 3> rest;  // rest positions, 1/16 grid units
};

}  // namespace rlpc
