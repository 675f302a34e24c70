// 6.8 End of sequence, parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

struct EndOfSequence {
  std::uint32_t index_distance = 0;  // bytes from the start of the GOF index; 0: no index
  std::uint32_t num_frames = 0;      // frames of the sequence
};

inline EndOfSequence parse_end_of_sequence(BitReader& r, const SequenceHeader& header) {
  EndOfSequence end{r.u(32, "index_distance"), header.num_frames};
  if (header.open_end_flag) {
    const std::uint64_t at = r.bit_pos();
    end.num_frames = r.u(32, "num_sequence_frames");
    r.require({"num_sequence_frames", end.num_frames, at}, {0, kMaxFrames}, "R-LVL-03");
  }
  r.expect_end();
  return end;
}

// Returns the size of the payload in bytes.
constexpr std::uint32_t end_of_sequence_bytes(const SequenceHeader& header) {
  return header.open_end_flag ? 8 : 4;
}

}  // namespace rlpc
