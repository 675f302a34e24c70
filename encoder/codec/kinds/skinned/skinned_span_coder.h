// Encodes one GOF as a skinned mesh, at varying quantiser steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/codec/kinds/skinned/search/bone_search.h"
#include "encoder/codec/kinds/skinned/search/skinned_context.h"
#include "encoder/codec/kinds/skinned/search/skinned_trial.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"
#include "encoder/codec/spans/step_cache.h"

namespace rlpc {

class SkinnedSpanCoder : public SpanCoder {
 public:
  // Keeps references to both.
  SkinnedSpanCoder(const SkinnedContext& context, const SpanFrames& frames)
      : context_(context),
        frames_(frames),
        has_followers_(frames.has_followers),
        bones_(context, frames) {}

  void set_progress(const Progress& progress) override { bones_.set_progress(progress); }
  void analyse(double analysis_step) override;
  std::optional<double> expected_error(double step) const override;
  bool needs_frames(double step, double analysis_step) const override;
  EncodedSpan encode(double step, double analysis_step) override;
  void release_analysis() override;
  void keep_num_components() override;

 private:
  // A draft: its step, squared error and analysis.
  struct Draft {
    double step = 0.0;
    double error = 0.0;
    SkinnedAnalysis analysis;
    std::size_t num_trajectories = 0;  // set if it is encoded
    bool is_encoded = false;           // false: the error is expected from its components
  };

  static double error_at(double step, const Draft& draft);
  static double step_of_error(double wanted, const Draft& draft);
  Draft survey(SkinnedCandidate likeliest, double step) const;
  void choose(double step);
  const SkinnedAnalysis& analysis_for(double step);
  bool is_valid_for(double step) const;
  bool follows_step() const { return choice_->rig.bones.size() > 1; }

  const SkinnedContext& context_;
  const SpanFrames& frames_;  // may be freed
  bool has_followers_;
  BoneSearch bones_;
  // Bones and tools, chosen for the step at which the target is expected.
  std::optional<SkinnedCandidate> choice_;
  std::optional<Draft> draft_;                         // draft of choice_
  StepCache<SkinnedAnalysis> analysis_;                // analysis of choice_
  std::vector<std::pair<double, std::size_t>> coded_;  // step and trajectories of each encoding
  std::optional<std::size_t> kept_;  // trajectories to code; none: those worth their bits
};

}  // namespace rlpc
