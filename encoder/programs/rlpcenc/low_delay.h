// rlpcenc --low-delay: encodes frames one by one, from files or as they arrive.
#pragma once

#include <functional>
#include <optional>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/frame_stream.h"
#include "encoder/programs/rlpcenc/encode_options.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// Report, and the error of the input, if any, before which the stream ends.
struct LowDelayReport {
  EncodeReport report;
  std::optional<InputError> stopped;
};

// Encode all frames. flush: called after each frame. Errors: the first frame, the settings or
// the sink.
InputResult<LowDelayReport> encode_low_delay(FrameSource& source, const EncodeOptions& options,
                                             const ByteSink& sink, const Progress& progress);
InputResult<LowDelayReport> encode_live(FrameStream& stream, const EncodeOptions& options,
                                        const ByteSink& sink,
                                        const std::function<bool()>& flush);

}  // namespace rlpc
