// What an encoding would come to, without a stream.
#pragma once

#include <cstdint>

#include "encoder/rlpc_encoder.h"

namespace rlpc {

struct Expectation {
  EncodeReport report;  // of the whole sequence, bytes and bpvf by extrapolation unless exact
  std::uint32_t frames_encoded = 0;
  bool exact() const { return frames_encoded == report.header.num_frames; }
};

// Up to 1024 frames, or eight times as many as a GOF may have, everything is encoded as
// encode() does, and what it reports is exact. Of longer sequences, eight stretches that are
// spread evenly are, as if they were all: bits and numbers of GOFs are taken for those of as
// many frames, errors are those of the stretches. A stretch has about 128 frames, whole GOFs,
// or is as long as a GOF may be.
InputResult<Expectation> expect_encoding(FrameSource& source, const EncoderSettings& settings,
                                         const Progress& progress = {});

}  // namespace rlpc
