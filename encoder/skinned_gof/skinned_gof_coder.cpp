#include "encoder/skinned_gof/skinned_gof_coder.h"

#include <utility>

#include "encoder/skinned_gof/quantise/skinned_gof_encoder.h"
#include "encoder/skinned_gof/search/bone_search.h"
#include "encoder/skinned_gof/search/tool_search.h"

namespace rlpc {

void SkinnedGofCoder::choose(double step) {
  const SkinnedTrials trials(context_, frames_, step);
  const BoneSearch bones(context_, frames_, trials);
  if (context_.settings.preset == Preset::kFast && context_.settings.main.bones == 0) {
    choice_ = {bones.guess_one_bone(), {}, usual_settings(context_.settings)};
    return;
  }
  SkinnedTrial best = search_tools(context_, trials, bones.search());
  choice_ = std::move(best.candidate);
  choice_->settings.draft = false;
  forecast_ = {step, best.error};
}

const SkinnedAnalysis& SkinnedGofCoder::analysis_for(double step) {
  return analysis_.get(
      step, [&] { return analyse_candidate(context_, frames_, *choice_, step); });
}

// Whether what is coded follows the step, with the analysis that there is: it has trajectories.
bool SkinnedGofCoder::is_valid_for(double step) const {
  // tuned (off: 0): A stored analysis serves other steps only if it codes at least this many
  // trajectories. With fewer, the error comes from bones and rest positions, and a new analysis
  // must follow the step.
  constexpr std::size_t kEnough = 4;
  SkinnedSettings draft = choice_->settings;
  draft.draft = true;
  return has_trajectories(kEnough, *analysis_.last(), draft, step);
}

bool SkinnedGofCoder::needs_frames(double step, double analysis_step) const {
  return !choice_ || !analysis_.has(analysis_step) || !is_valid_for(step);
}

void SkinnedGofCoder::analyse(double analysis_step) {
  if (!choice_) choose(analysis_step);
  analysis_for(analysis_step);
}

std::optional<double> SkinnedGofCoder::expected_error(double step) const {
  const SkinnedAnalysis* analysis = analysis_.last();
  if (analysis == nullptr || analysis->model.bones.size() > 1) return std::nullopt;
  return expected_squared_error(*analysis, step);
}

EncodedGof SkinnedGofCoder::encode(double step, double analysis_step) {
  analyse(analysis_step);
  if (!is_valid_for(step)) analysis_for(step);
  return encode_skinned_gof(context_, *analysis_.last(), choice_->settings, step);
}

}  // namespace rlpc
