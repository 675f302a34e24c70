// 6.9 GOF index, parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/memory/owned.h"
#include "common/result.h"

namespace rlpc {

struct GofLocation {
  std::uint64_t offset = 0;  // bytes from the start of the stream to the GOF unit
  std::uint32_t first_frame = 0;
};

// Place and index of a rig unit.
struct RigLocation {
  std::uint64_t offset = 0;
  std::uint32_t rig_idx = 0;
};

struct GofIndex {
  Vector<GofLocation> gofs;
  Vector<RigLocation> rigs;
  std::uint64_t end = 0;  // end of the bytes of the last GOF
};

// Parses the lists, up to the alignment. max_bytes: memory that each may take. Errors are left
// in `r`.
GofIndex parse_index_lists(BitReader& r, const SequenceHeader& header, std::uint64_t max_bytes);

// 6.9 gof_index( ). Offsets are not checked against the units here.
Result<GofIndex> parse_gof_index(BitReader& r, const SequenceHeader& header);

}  // namespace rlpc
