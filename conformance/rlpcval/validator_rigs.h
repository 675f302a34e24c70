// 8.16.1: the shared rigs that are kept, as the validator knows them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "conformance/rlpcval/validator.h"

namespace rlpc {

struct SeenRig {
  std::shared_ptr<const SharedRig> rig;  // null: none that could be read
  bool lost = false;                     // there is, or may be, a rig that could not be read
  bool suspect = false;
  FindingUnit place;
  std::uint64_t bit_pos = 0;  // start of the payload of its unit
  bool is_used = false;       // a GOF has used it
  std::vector<bool> moves;    // [trajectory]: moves in a GOF that uses the rig
};
using SeenRigs = std::array<SeenRig, kMaxRigs>;  // [rig_idx]

RigSlots slots_of(const SeenRigs& rigs);

}  // namespace rlpc
