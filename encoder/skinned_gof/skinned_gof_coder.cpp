#include "encoder/skinned_gof/skinned_gof_coder.h"

#include <utility>

#include "encoder/skinned_gof/quantise/skinned_gof_encoder.h"
#include "encoder/skinned_gof/search/bone_search.h"
#include "encoder/skinned_gof/search/tool_search.h"

namespace rlpc {

bool SkinnedGofCoder::must_choose(double analysis_step) const {
  if (choice_.count == 0) return true;
  if (choice_.count >= kMostChoices) return false;
  return !analysis_serves(choice_.step, analysis_step);
}

void SkinnedGofCoder::choose(double step) {
  const Preset preset = context_.settings.preset;
  const SkinnedTrials trials(context_, frames_, step);
  const BoneSearch bones(context_, frames_, trials);
  const Choice before = std::move(choice_);
  choice_ = {{}, step, before.count + 1};
  analysis_.release();
  if (preset == Preset::kFast && context_.settings.main.bones == 0) {
    choice_.candidate = {bones.guess_one_bone(), {}, usual_settings(context_.settings)};
    return;
  }
  const BoneCounts& counts = before.candidate.counts;
  SkinnedTrial best = counts.bones > 0 && preset != Preset::kSlow
                          ? bones.search_near(counts, step < before.step)
                          : bones.search();
  best = search_tools(context_, trials, std::move(best));
  choice_.candidate = std::move(best.candidate);
  analysis_.put(step, std::move(best.analysis));
}

const SkinnedAnalysis& SkinnedGofCoder::analysis_for(double step) {
  return analysis_.get(
      step, [&] { return SkinnedTrials(context_, frames_, step).analyse(choice_.candidate); });
}

// Whether the cached analysis gives enough trajectories at the step. With fewer, the error
// hardly depends on the step, because the rest of the GOF is quantised in the analysis.
bool SkinnedGofCoder::is_valid_for(double step) const {
  constexpr std::size_t kEnough =
      4;  // tuned (off: 0): trajectories, for errors to follow steps
  return has_trajectories(kEnough, *analysis_.last(), choice_.candidate.settings, step);
}

bool SkinnedGofCoder::needs_frames(double step, double analysis_step) const {
  return must_choose(analysis_step) || !analysis_.has(analysis_step) || !is_valid_for(step);
}

void SkinnedGofCoder::analyse(double analysis_step) {
  if (must_choose(analysis_step)) choose(analysis_step);
  analysis_for(analysis_step);
}

std::optional<double> SkinnedGofCoder::expected_error(double step) const {
  const SkinnedAnalysis* analysis = analysis_.last();
  if (analysis == nullptr || analysis->gof.bones.size() > 1) return std::nullopt;
  return expected_squared_error(*analysis, step);
}

EncodedGof SkinnedGofCoder::encode(double step, double analysis_step) {
  analyse(analysis_step);
  if (!is_valid_for(step)) analysis_for(step);
  return encode_skinned_gof(context_, *analysis_.last(), choice_.candidate.settings, step);
}

}  // namespace rlpc
