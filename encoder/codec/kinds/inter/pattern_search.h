// Chooses the pattern and the number of patches of an inter GOF by its bits at equal error.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/codec/kinds/inter/frame_order.h"
#include "encoder/codec/kinds/inter/inter_trial.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/span_coder.h"

namespace rlpc {

// The patterns that a GOF may have under the settings, at least one: those to be compared.
//
//   is_open_ended  frames are decoded as they arrive, and must not wait for later ones
std::vector<FramePattern> patterns_of(const EncoderSettings& settings, bool is_open_ended,
                                      std::uint32_t num_frames);

// Likewise, numbers of patches, ascending.
std::vector<std::uint32_t> patches_of(const EncoderSettings& settings, bool is_open_ended,
                                      std::uint32_t num_frames);

// The choices that numbers of patches are compared by: with the first pattern, and if there is
// one, with the first whose frames are predicted from both sides, where motions are small.
std::vector<InterChoice> choices_of_patches(const std::vector<FramePattern>& patterns,
                                            const std::vector<std::uint32_t>& patches);

// Starts the encoding of a GOF by a choice.
using StartTrial = std::function<std::unique_ptr<InterTrial>(const InterChoice&)>;

// Encodes a GOF by each choice, side by side on several threads. Half of them end early, the
// costlier ones, each time twice as many frames are coded, until two are left: what moves later
// may move in other ways, so that these are coded to the end. They are compared at equal error:
// after the first of these parts, the steps of all are scaled so that they have about the error
// of the first choice, and the part is coded again. What is coded in vain takes as long as two
// and a half encodings, if there are four choices that take equally long. Returns the one that
// is left.
std::unique_ptr<InterTrial> cheapest(const std::vector<InterChoice>& choices,
                                     std::uint32_t num_frames, const StartTrial& start);

}  // namespace rlpc
