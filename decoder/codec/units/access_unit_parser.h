// Builds an access unit from its units; all readers of streams hand their units to it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/syntax/stream_context.h"
#include "common/result.h"
#include "decoder/codec/parse/gof_parser.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/slice_cut.h"

namespace rlpc {

// Checks every size against the level, and the memory that the GOF needs against the limit,
// before allocating. After an error it can only be destroyed.
class AccessUnitParser {
 public:
  // The context must outlive it, and have its connectivity set. Slices outside the cut are
  // treated as absent.
  AccessUnitParser(const StreamContext& context, const MemoryLimit& memory,
                   const SliceCut& cut = {});

  // In the functions below, `r` covers exactly the payload of a unit; unit_bytes: size of the
  // unit with header and CRC.
  //
  // 6.5 gof( ), once. first_frame: the first frame that the GOF must have. rigs: the shared
  // rigs alive at the GOF unit.
  Result<bool> gof(BitReader& r, std::uint32_t first_frame, const RigSlots& rigs,
                   std::uint64_t unit_bytes);
  // Returns the kind of the GOF, once its unit has been parsed.
  GofKind kind() const { return kind_; }
  // Returns whether the cut drops the slice whose payload `r` begins. If so, it need not be
  // parsed.
  bool drops(BitReader& r);
  // 6.12 slice_unit( ) or 6.14.2 frame_unit( ), any number of times. unit_bit_pos: start of the
  // unit.
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos, std::uint64_t unit_bytes);
  // 6.7 gof_hash( ), at most once.
  Result<bool> hash(BitReader& r);

  // Returns the estimated memory of what has been parsed so far, and of the shared rigs alive;
  // 0 before the GOF unit.
  std::uint64_t memory_bytes() const;
  // Returns the access unit, after the last unit.
  AccessUnit finish();

 private:
  const StreamContext& context_;
  MemoryLimit memory_;
  SliceCut cut_;
  std::uint32_t num_frames_ = 0;
  GofKind kind_ = GofKind::kCluster;
  std::unique_ptr<GofParser> parser_;
  AccessUnit access_unit_;
};

}  // namespace rlpc
