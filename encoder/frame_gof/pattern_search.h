// Chooses the pattern of a GOF of frames by its bits at equal error.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/frame_gof/frame_order.h"
#include "encoder/frame_gof/frame_encoding.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// The patterns that a GOF may have under the settings, at least one: those to be compared.
//
//   is_open_ended  frames are decoded as they arrive, and must not wait for later ones
std::vector<FramePattern> patterns_of(const EncoderSettings& settings, bool is_open_ended,
                                      std::uint32_t num_frames);

// Encodes a GOF by each pattern, side by side on several threads. Half of them end early, the
// costlier ones, each time twice as many frames are coded; the last choice is made at half of
// the frames. What is coded in vain takes as long as one encoding by the chosen pattern, if
// there are four.
//
//   make  starts the encoding by a pattern
EncodedGof encode_cheapest(
    const std::vector<FramePattern>& patterns, std::uint32_t num_frames,
    const std::function<std::unique_ptr<FrameEncoding>(const FramePattern&)>& make);

}  // namespace rlpc
