// Builds a shared rig from its units (6.13).
#pragma once

#include <cstdint>
#include <memory>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/syntax/stream_context.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/slice_cut.h"

namespace rlpc {

// Parsed shared rig: its unit and its slice units.
struct ParsedRig {
  std::uint32_t rig_idx = 0;
  std::shared_ptr<const SharedRig> rig;
  Vector<SliceEntry> slices;  // in the order of the stream
  std::uint64_t bytes = 0;    // size of its unit
};

// Checks limits as AccessUnitParser does. After an error it can only be destroyed.
class RigParser {
 public:
  // The context must outlive it, and have its connectivity set. Slices outside the cut are
  // treated as absent.
  RigParser(const StreamContext& context, const MemoryLimit& memory, const SliceCut& cut = {})
      : parser_(context.header, *context.meshes, memory, cut) {}

  // 6.13 rig( ), once; then slices as in AccessUnitParser. rigs: the rigs alive before it.
  Result<bool> rig(BitReader& r, const RigSlots& rigs, std::uint64_t unit_bytes) {
    if (auto ok = parser_.rig(r, rigs); !ok) return ok;
    parsed_.bytes = unit_bytes;
    return true;
  }
  bool drops(BitReader& r) { return parser_.drops(r); }
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos, std::uint64_t unit_bytes) {
    if (auto ok = parser_.slice(r, unit_bit_pos); !ok) return ok;
    if (!parser_.last_slice()) return true;
    parsed_.slices.push_back(*parser_.last_slice());
    parsed_.slices.back().bytes = unit_bytes;
    return true;
  }
  // Returns the estimated memory, as AccessUnitParser does.
  std::uint64_t memory_bytes() const { return parser_.memory_bytes(); }
  // Returns the shared rig, after the last unit.
  ParsedRig finish() {
    parsed_.rig_idx = parser_.rig_idx();
    parsed_.rig = parser_.finish_rig();
    return std::move(parsed_);
  }

 private:
  SkinnedGofParser parser_;
  ParsedRig parsed_;
};

}  // namespace rlpc
