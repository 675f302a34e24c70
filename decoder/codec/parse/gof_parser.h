// Interface for parsing the units of one GOF of any kind.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/memory/owned.h"
#include "common/result.h"

namespace rlpc {

// Each `r` covers exactly the payload of a unit. After an error it can only be destroyed.
class GofParser : public Owned {
 public:
  GofParser() = default;
  GofParser(const GofParser&) = delete;
  GofParser& operator=(const GofParser&) = delete;
  virtual ~GofParser() = default;

  // Parses the GOF unit after its header. rigs: the shared rigs alive at it.
  virtual Result<bool> gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) = 0;
  // Parses a slice or frame unit, and adds its entry, without bytes, unless the cut drops it.
  // unit_bit_pos: start of the unit.
  virtual Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos,
                             Vector<SliceEntry>& slices);
  // Returns whether the cut drops the slice whose payload `r` begins. If so, it need not be
  // parsed.
  virtual bool drops(BitReader& /*r*/) { return false; }
  // Returns whether a slice has been dropped so far.
  virtual bool is_cut() const { return false; }
  // Returns the estimated memory of what has been parsed so far, and of the shared rigs alive;
  // 0 if no slices follow.
  virtual std::uint64_t memory_bytes() const { return 0; }
  // Returns the GOF, after its last unit.
  virtual AnyGof take_gof() = 0;
};

}  // namespace rlpc
