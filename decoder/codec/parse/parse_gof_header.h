// 6.5 gof( ), up to the part specific to its kind, parsing side.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/syntax/gof_header.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// Parses the first element of a GOF unit, with which decoding resumes after damage. Errors are
// left in `r`.
std::uint32_t parse_first_frame(BitReader& r, Range range);

// Parse the elements after it. frames_left: frames of the sequence from the first of the GOF
// on. Errors are left in `r`.
std::uint32_t parse_num_gof_frames(BitReader& r, const SequenceHeader& header,
                                   std::uint32_t frames_left);
GofKind parse_gof_kind(BitReader& r, const SequenceHeader& header);

// Parses the header. expected_first_frame: below num_frames of the sequence. Errors are left in
// `r`.
GofHeader parse_gof_header(BitReader& r, const SequenceHeader& header,
                           std::uint32_t expected_first_frame);

}  // namespace rlpc
