// Candidates of the search for a skinned GOF, and trial encodings of them.
#pragma once

#include <cstdint>
#include <optional>

#include "encoder/codec/kinds/skinned/quantise/skinned_analysis.h"
#include "encoder/codec/kinds/skinned/search/skinned_context.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Numbers that a fit was asked for; both 0 for a single bone.
struct BoneCounts {
  std::uint32_t bones = 0;
  std::uint32_t influences = 0;  // maximum bones per vertex during the fit
};

// tuned: With bones, the squared error is about this power of the step, if they follow it.
inline constexpr double kErrorPower = 1.7;

struct SkinnedCandidate {
  Rig rig;
  BoneCounts counts;
  SkinnedSettings settings;
};

struct SkinnedTrial {
  SkinnedCandidate candidate;
  SkinnedAnalysis analysis;
  double cost = 0.0;   // Lagrangian cost
  double error = 0.0;  // its part that is squared error
  double bits = 0.0;
  std::size_t num_trajectories = 0;
};

// None: no trial so far.
using BestTrial = std::optional<SkinnedTrial>;

// Returns the cheaper of the two; `before` in a tie.
BestTrial cheaper(BestTrial before, SkinnedTrial trial);

// Encodes candidates at one quantiser step (grid units), as drafts: tracks are coded only as
// well as comparing candidates needs, and errors are those of a sample of the frames.
class SkinnedTrials {
 public:
  // Keeps references to context and frames.
  SkinnedTrials(const SkinnedContext& context, const SpanFrames& frames, double step)
      : context_(context), frames_(frames), step_(step) {}

  double step() const { return step_; }
  // Encodes a draft. before: as in analyse_skinned_gof().
  SkinnedTrial run(SkinnedCandidate candidate, const SkinnedAnalysis* before = nullptr) const;
  // Encodes the candidate as a whole, not as a draft.
  SkinnedTrial whole(const SkinnedCandidate& candidate) const;
  // Encodes the candidate with other settings.
  SkinnedTrial again(const SkinnedTrial& trial, const SkinnedSettings& settings) const;
  // Tries the candidate with other settings; none if that is not cheaper.
  BestTrial with_settings(const SkinnedTrial& trial, const SkinnedSettings& settings) const;

 private:
  SkinnedTrial encode(SkinnedCandidate candidate, SkinnedAnalysis analysis) const;

  const SkinnedContext& context_;
  const SpanFrames& frames_;
  double step_;
};

// Returns the analysis that encode_skinned_gof() starts from.
SkinnedAnalysis analyse_candidate(const SkinnedContext& context, const SpanFrames& frames,
                                  const SkinnedCandidate& candidate, double step,
                                  const SkinnedAnalysis* before = nullptr);

// Quantises the trajectories and writes the units. step: quantiser step, grid units.
// has_followers: later spans may use the shared rig.
EncodedSpan encode_skinned_gof(const SkinnedContext& context, const SkinnedAnalysis& analysis,
                               const SkinnedSettings& settings, double step,
                               bool has_followers);

}  // namespace rlpc
