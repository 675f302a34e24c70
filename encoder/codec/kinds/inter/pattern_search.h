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

// Returns the patterns to compare that a GOF may have under the settings; at least one.
//
//   is_open_ended  frames are decoded as they arrive, and must not wait for later ones
std::vector<FramePattern> patterns_of(const EncoderSettings& settings, bool is_open_ended,
                                      std::uint32_t num_frames);

// Returns the numbers of patches to compare, ascending.
std::vector<std::uint32_t> patches_of(const EncoderSettings& settings, bool is_open_ended,
                                      std::uint32_t num_frames);

// Returns choices that compare numbers of patches: with the first pattern and, if there is one,
// the first whose frames are predicted from both sides, where motions are small.
std::vector<InterChoice> choices_of_patches(const std::vector<FramePattern>& patterns,
                                            const std::vector<std::uint32_t>& patches);

// Returns the factor of the steps that leads to about the wanted squared error; 1 if it is near
// enough.
double scale_to(double wanted, double squared_error);

// Starts the encoding of a GOF by a choice.
using StartTrial = std::function<std::unique_ptr<InterTrial>(const InterChoice&)>;

// Encodes a GOF by each choice, in parallel on several threads. Each time twice as many frames
// are coded, the costlier half of the encodings ends, until two are left. These are coded to
// the end, since later motion may differ. Encodings are compared at equal error: after the
// first part, the steps of all are scaled so that they have about the error of the first
// choice, and the part is coded again. With four choices that take equally long, discarded
// encodings take as long as two and a half whole ones. Returns the cheapest.
std::unique_ptr<InterTrial> cheapest(const std::vector<InterChoice>& choices,
                                     std::uint32_t num_frames, const StartTrial& start);

// Returns the choice that costs least at equal error, by the first frames.
InterChoice cheapest_at_start(const std::vector<InterChoice>& choices, std::uint32_t num_frames,
                              const StartTrial& start);

}  // namespace rlpc
