// Chooses the settings of a GOF of frames.
#pragma once

#include "common/frame_gof/frame_gof.h"
#include "common/mesh/coded_mesh.h"
#include "common/syntax/sequence_header.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// step: quantiser step, in grid steps; not used if the target is lossless.
FrameSettings choose_frame_settings(const SequenceHeader& header,
                                    const EncoderSettings& settings, const CodedMesh& layers,
                                    double step);

}  // namespace rlpc
