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
  void choose(double step);
  const SkinnedAnalysis& analysis_for(double step);
  bool is_valid_for(double step) const;

  const SkinnedContext& context_;
  const GofFrames& frames_;
  // Bones and tools, chosen for the first step.
  std::optional<SkinnedCandidate> choice_;
  struct Forecast {
    double step = 0.0;
    double squared_error = 0.0;
  };
  Forecast forecast_;  // the error of the choice, from its draft
  StepCache<SkinnedAnalysis> analysis_;  // of the choice
};

}  // namespace rlpc
