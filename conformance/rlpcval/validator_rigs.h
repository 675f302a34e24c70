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
  bool lost = false;                     // there is, or may be, one that could not be read
  bool suspect = false;
  FindingUnit place;
  std::uint64_t bit_pos = 0;  // of the payload of its unit
  bool is_used = false;       // by a GOF so far
  std::vector<bool> moves;    // [trajectories] not still in all these GOFs
};
using SeenRigs = std::array<SeenRig, kMaxRigs>;  // by rig_idx

RigSlots slots_of(const SeenRigs& rigs);

}  // namespace rlpc
