// Encodes one GOF as a skinned mesh, at varying quantiser steps.
#pragma once

#include <optional>

#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_frames.h"
#include "encoder/gof/step_cache.h"
#include "encoder/skinned_gof/search/skinned_context.h"
#include "encoder/skinned_gof/search/skinned_trial.h"

namespace rlpc {

class SkinnedGofCoder : public GofCoder {
 public:
  // Keeps references to both.
  SkinnedGofCoder(const SkinnedContext& context, const GofFrames& frames)
      : context_(context), frames_(frames) {}

  void analyse(double analysis_step) override;
  std::optional<double> expected_error(double step) const override;
  bool needs_frames(double step, double analysis_step) const override;
  EncodedGof encode(double step, double analysis_step) override;
  void release_analysis() override { analysis_.release(); }

 private:
  // The chosen bones and tools, and the step that they were chosen for.
  struct Choice {
    SkinnedCandidate candidate;
    double step = 0.0;
    int count = 0;  // choices so far
  };

  // Whether bones and tools must be chosen (again) for a step.
  bool must_choose(double analysis_step) const;
  void choose(double step);
  const SkinnedAnalysis& analysis_for(double step);
  bool is_valid_for(double step) const;

  const SkinnedContext& context_;
  const GofFrames& frames_;
  Choice choice_;
  StepCache<SkinnedAnalysis> analysis_;  // of choice_.candidate
};

}  // namespace rlpc
