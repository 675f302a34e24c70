// Predicts the outcome of an encoding without writing a stream.
#pragma once

#include <cstdint>

#include "encoder/codec/report.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

struct Expectation {
  EncodeReport report;  // for the whole sequence; extrapolated unless exact
  std::uint32_t frames_encoded = 0;
  bool exact() const { return frames_encoded == report.header.num_frames; }
};

// Encodes a sequence of at most 1024 frames, or of at most eight GOFs of maximum length if
// these are longer, completely; the report is then exact. For a longer sequence, eight evenly
// spaced stretches are encoded as if they were the whole sequence: bits and numbers of GOFs are
// scaled by the number of frames, errors are those of the stretches. A stretch consists of
// whole GOFs with about 128 frames in total, or of one GOF if that may be longer.
//
// Errors: as encode(), except that no sink can fail.
InputResult<Expectation> expect_encoding(FrameSource& source, const EncoderSettings& settings,
                                         const Progress& progress = {});

}  // namespace rlpc
