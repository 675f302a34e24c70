// Candidates of the search for a skinned GOF, and what they cost.
#pragma once

#include <cstdint>
#include <optional>

#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_frames.h"
#include "encoder/skinned_gof/fit/rig.h"
#include "encoder/skinned_gof/quantise/skinned_analysis.h"
#include "encoder/skinned_gof/search/skinned_context.h"

namespace rlpc {

// What bones were looked for: so many, with vertices that follow so many; 0 of one.
struct BoneCounts {
  std::uint32_t bones = 0;
  std::uint32_t influences = 0;
};

struct SkinnedCandidate {
  Rig rig;
  BoneCounts counts;
  SkinnedSettings settings;
};

struct SkinnedTrial {
  SkinnedCandidate candidate;
  SkinnedAnalysis analysis;
  double cost = 0.0;  // Lagrangian
};

// None: nothing was tried so far.
using BestTrial = std::optional<SkinnedTrial>;

// The cheaper one; that before, where both cost the same.
BestTrial cheaper(BestTrial before, SkinnedTrial trial);

// Codes candidates at one step of the quantisers, grid units. Everything is kept by reference.
class SkinnedTrials {
 public:
  SkinnedTrials(const SkinnedContext& context, const GofFrames& frames, double step)
      : context_(context), frames_(frames), step_(step) {}

  double step() const { return step_; }
  SkinnedAnalysis analyse(const SkinnedCandidate& candidate) const;
  SkinnedTrial run(SkinnedCandidate candidate) const;
  // The trial, or one with other settings where that costs less.
  SkinnedTrial with_settings(SkinnedTrial trial, const SkinnedSettings& settings) const;

 private:
  double cost(const SkinnedAnalysis& analysis, const SkinnedSettings& settings) const;

  const SkinnedContext& context_;
  const GofFrames& frames_;
  double step_;
};

EncodedGof encode_skinned_gof(const SkinnedContext& context, const SkinnedAnalysis& analysis,
                              const SkinnedSettings& settings, double step);

}  // namespace rlpc
