// Chooses the settings of a GOF of frames.
#pragma once

#include "common/frame_gof/frame_gof.h"
#include "common/mesh/coded_mesh.h"
#include "common/syntax/sequence_header.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// step: quantiser step, in grid steps; not used if the target is lossless. Of a pattern with
// several depths, the root mean square of theirs, so that the error, and what a bit is worth,
// are about those of other patterns.
FrameSettings choose_frame_settings(const SequenceHeader& header,
                                    const EncoderSettings& settings, const CodedMesh& layers,
                                    const FramePattern& pattern, double step);

}  // namespace rlpc
