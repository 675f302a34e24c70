#include "encoder/codec/kinds/skinned/skinned_span_coder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/codec/kinds/skinned/quantise/skinned_gof_encoder.h"
#include "encoder/codec/kinds/skinned/search/bone_search.h"
#include "encoder/codec/kinds/skinned/search/tool_search.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {

namespace {

// tuned (off: 1): With bones, an analysis is used for steps within this factor. Their error is
// that of bones and rest positions, and follows the step only if these are coded again.
constexpr double kBonesServe = 1.03;
// tuned (off: 1): The principal components of a draft serve an encoding for steps within this
// factor, unless the preset is fast: they hold the errors of bones and rest positions, which
// are coded again.
constexpr double kComponentsServe = 1.2;

}  // namespace

// Returns the expected squared error of a trial at another step.
double SkinnedSpanCoder::error_at(double step, const Draft& draft) {
  if (draft.analysis.rig.bones.size() > 1) {
    return draft.error * det_exp2(kErrorPower * det_log2(step / draft.step));
  }
  return draft.error * expected_squared_error(draft.analysis, step) /
         expected_squared_error(draft.analysis, draft.step);
}

// Returns the draft that shows the step at which the target is expected: a draft of the
// likeliest bones or, with a single bone, its components.
SkinnedSpanCoder::Draft SkinnedSpanCoder::survey(SkinnedCandidate likeliest,
                                                 double step) const {
  if (likeliest.rig.bones.size() > 1) {
    SkinnedTrial trial = SkinnedTrials(context_, frames_, step).run(std::move(likeliest));
    return {step, trial.error, std::move(trial.analysis), trial.num_trajectories, true};
  }
  likeliest.settings.draft = true;
  SkinnedAnalysis analysis = bones_.analysis_of_one() != nullptr
                                 ? *bones_.analysis_of_one()
                                 : analyse_candidate(context_, frames_, likeliest, step);
  const double error = expected_squared_error(analysis, step);
  return {step, error, std::move(analysis), 0, false};
}

double SkinnedSpanCoder::step_of_error(double wanted, const Draft& draft) {
  constexpr double kFinestStep = 0.5;  // fixed: as in the search for the target
  constexpr double kFarthest = 50.0;   // fixed: as in the search for the target
  constexpr int kHalvings = 12;        // fixed: precise enough
  double low = draft.step / kFarthest;
  double high = draft.step * kFarthest;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (error_at(middle, draft) > wanted ? high : low) = middle;
  }
  return std::max(low, kFinestStep);
}

void SkinnedSpanCoder::choose(double step) {
  if (context_.settings.preset == Preset::kFast && context_.settings.main.bones == 0) {
    choice_ = bones_.likeliest(step);
    draft_ = survey(*choice_, step);
    bones_.release();
    return;
  }
  const Target& target = context_.settings.target;
  std::optional<Draft> first;
  std::optional<double> wanted_error;
  if (target.kind == Target::kKg && context_.settings.main.bones == 0) {
    first = survey(bones_.likeliest(step), step);
    const double part = target.likely_kg() / 100.0;
    wanted_error = part * part * bones_.squared_spread();
    step = step_of_error(*wanted_error, *first);
  }
  const SkinnedTrials trials(context_, frames_, step);
  SkinnedTrial best = search_tools(context_, trials, bones_.search(trials, wanted_error));
  choice_ = std::move(best.candidate);
  choice_->settings.draft = false;
  draft_ = Draft{step, best.error, std::move(best.analysis), best.num_trajectories, true};
  bones_.release();
}

// Without bones, reuses the components of the draft, as the only bone barely changes.
const SkinnedAnalysis& SkinnedSpanCoder::analysis_for(double step) {
  const double factor =
      context_.settings.preset == Preset::kFast ? kDraftServes : kComponentsServe;
  const bool keeps =
      draft_ && !follows_step() && is_within(factor, step, draft_->analysis.step_of_components);
  return analysis_.get(step, [&] {
    return analyse_candidate(context_, frames_, *choice_, step,
                             keeps ? &draft_->analysis : nullptr);
  });
}

// Whether an encoding with the present analysis follows the step: it has trajectories.
bool SkinnedSpanCoder::is_valid_for(double step) const {
  // tuned (off: 0): A stored analysis serves other steps only if it codes at least this many
  // trajectories. With fewer, the error comes from bones and rest positions, and a new analysis
  // must follow the step.
  constexpr std::size_t kEnough = 4;
  // Near the target, a new analysis for each step brings the error nearest to it.
  if (follows_step() && kept_) return step == analysis_.step();
  if (follows_step()) return is_within(kBonesServe, step, analysis_.step());
  SkinnedSettings draft = choice_->settings;
  draft.draft = true;
  return has_trajectories(kEnough, *analysis_.last(), draft, step);
}

bool SkinnedSpanCoder::needs_frames(double step, double analysis_step) const {
  if (!choice_) return true;
  if (follows_step()) return analysis_.last() == nullptr || !is_valid_for(step);
  return !analysis_.has(analysis_step) || !is_valid_for(step);
}

void SkinnedSpanCoder::analyse(double analysis_step) {
  const Stage stage("skinned GOFs");
  if (!choice_) choose(analysis_step);
  if (!draft_) analysis_for(analysis_step);
}

std::optional<double> SkinnedSpanCoder::expected_error(double step) const {
  // tuned (off: 1): Squared error of an encoding relative to that of its draft, whose residuals
  // of tracks are chosen one by one.
  constexpr double kDraftError = 0.92;
  if (draft_ && analysis_.last() == nullptr) {
    return (draft_->is_encoded ? kDraftError : 1.0) * error_at(step, *draft_);
  }
  if (!choice_ || follows_step() || analysis_.last() == nullptr) return std::nullopt;
  return expected_squared_error(*analysis_.last(), step);
}

EncodedSpan SkinnedSpanCoder::encode(double step, double analysis_step) {
  const Stage stage("skinned GOFs");
  if (!choice_) choose(analysis_step);
  if (!follows_step()) analysis_for(analysis_step);
  if (analysis_.last() == nullptr || !is_valid_for(step)) analysis_for(step);
  SkinnedSettings settings = choice_->settings;
  if (kept_) settings.min_trajectories = settings.max_trajectories = *kept_;
  EncodedSpan encoded =
      encode_skinned_gof(context_, *analysis_.last(), settings, step, has_followers_);
  coded_.emplace_back(step, encoded.components);
  return encoded;
}

// Of numbers that were worth their bits at about the last step, takes the smallest: where they
// differ much, the components between are barely worth theirs.
void SkinnedSpanCoder::keep_num_components() {
  if (kept_ || coded_.empty()) return;
  constexpr double kNear = 1.2;  // fixed: farther steps are too coarse
  for (const auto& [step, count] : coded_) {
    if (is_within(kNear, step, coded_.back().first))
      kept_ = std::min(kept_.value_or(count), count);
  }
}

void SkinnedSpanCoder::release_analysis() {
  analysis_.release();
  draft_.reset();
}

}  // namespace rlpc
