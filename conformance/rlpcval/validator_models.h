// 8.16.1: the skinned models that are kept, as the validator knows them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/codec/kinds/skinned/model_slots.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "conformance/rlpcval/validator.h"

namespace rlpc {

struct SeenModel {
  std::shared_ptr<const SkinnedModel> model;  // null: none that could be read
  bool lost = false;                          // there is, or may be, one that could not be read
  bool suspect = false;
  FindingUnit place;
  std::uint64_t bit_pos = 0;  // of the payload of its unit
  bool is_used = false;       // by a GOF so far
  std::vector<bool> moves;    // [trajectories] not still in all these GOFs
};
using SeenModels = std::array<SeenModel, kMaxModels>;  // by model_idx

ModelSlots slots_of(const SeenModels& models);

}  // namespace rlpc
