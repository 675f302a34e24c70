// 6.3 Sequence header, parsing side.
#pragma once

#include "common/codec/bits/bit_reader.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/result.h"

namespace rlpc {

// Places of elements of a sequence header, in bits from the start of the stream.
struct SequenceHeaderPlaces {
  std::uint64_t num_vertices_minus1 = 0;
  std::uint64_t num_triangles = 0;
  std::uint64_t open_end_flag = 0;
  std::uint64_t num_frames_minus1 = 0;
  std::uint64_t frame_rate_numerator_minus1 = 0;
};

// 6.3 sequence_header( ). `r` covers exactly the payload of the unit. Errors are left in `r`;
// if it stops before the frame rate, the place of that is 0.
SequenceHeader parse_sequence_header(BitReader& r, std::uint32_t version_minor,
                                     SequenceHeaderPlaces& places);
// Returns the header, or the first error. places: may be null.
Result<SequenceHeader> parse_sequence_header(BitReader& r, std::uint32_t version_minor,
                                             SequenceHeaderPlaces* places = nullptr);

}  // namespace rlpc
