// rlpcenc --low-delay: frames are encoded one by one, from files or as they arrive.
#pragma once

#include <functional>
#include <optional>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/frame_stream.h"
#include "encoder/programs/rlpcenc/encode_options.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// The stream ends with the frames before an error of the input.
struct LowDelayReport {
  EncodeReport report;
  std::optional<InputError> stopped;
};

// flush: called after each frame. Errors: of the first frame; settings; the sink.
InputResult<LowDelayReport> encode_low_delay(FrameSource& source, const EncodeOptions& options,
                                             const ByteSink& sink, const Progress& progress);
InputResult<LowDelayReport> encode_live(FrameStream& stream, const EncodeOptions& options,
                                        const ByteSink& sink,
                                        const std::function<bool()>& flush);

}  // namespace rlpc
