#include "encoder/codec/kinds/skinned/search/skinned_trial.h"

#include <algorithm>
#include <utility>

#include "encoder/codec/kinds/skinned/quantise/skinned_gof_encoder.h"
#include "encoder/codec/kinds/skinned/search/span_units.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// tuned (off: 0): Levels of hierarchical tracks besides level 0, with the High profile. Each
// further level doubles the distance over which level 0 is predicted.
constexpr int kTrackLevels = 1;

}  // namespace

SkinnedSettings usual_settings(const EncoderSettings& settings) {
  const MainTools& tools = settings.main;
  SkinnedSettings usual;
  usual.prediction = tools.layer_groups > 1 ? Prediction::kLayers
                                            : tools.prediction.value_or(Prediction::kLayers);
  if (!tools.geometry_weights) usual.damping_log2 = 0;
  if (!tools.outer_ring) usual.outer_weight = 0;
  if (!tools.outer_ring) usual.outer_scale = 0;
  usual.layer_steps = tools.layer_steps;
  if (settings.profile == Profile::kHigh) {
    usual.track_levels =
        tools.track_levels ? static_cast<int>(*tools.track_levels) : kTrackLevels;
    usual.temporal_layers = static_cast<int>(tools.temporal_layers);
    if (!tools.track_levels) {
      usual.track_levels = std::max(usual.track_levels, usual.temporal_layers - 1);
    }
    usual.rest = tools.rest.value_or(RestTools::kCounterparts);
    usual.num_adaptive_factors = tools.adaptive_factors.value_or(kLevels.back().max_components);
  }
  if (settings.preset == Preset::kFast) usual.rounding = Rounding::kDeadZone;
  if (settings.target.kind == Target::kMaxError) usual.rounding = Rounding::kNearest;
  usual.temporal_weights = tools.temporal_weights;
  usual.cobra_steps = tools.cobra_steps;
  usual.component_groups = tools.component_groups;
  usual.layer_groups = tools.layer_groups;
  usual.layer_cuts = tools.layer_cuts;
  usual.max_trajectories = kLevels.back().max_components;
  if (settings.components > 0) usual.max_trajectories = settings.components;
  return usual;
}

BestTrial cheaper(BestTrial before, SkinnedTrial trial) {
  if (before && !(trial.cost < before->cost)) return before;
  return trial;
}

SkinnedAnalysis analyse_candidate(const SkinnedContext& context, const SpanFrames& frames,
                                  const SkinnedCandidate& candidate, double step,
                                  const SkinnedAnalysis* before) {
  return analyse_skinned_gof(context.meshes[candidate.settings.prediction],
                             context.header.position_bits, frames, candidate.rig,
                             candidate.settings, step, before);
}

SkinnedTrial SkinnedTrials::encode(SkinnedCandidate candidate, SkinnedAnalysis analysis) const {
  const EncodedSpan encoded =
      encode_skinned_gof(context_, analysis, candidate.settings, step_, false);
  const double error = squared_error(frames_, encoded.frame, kErrorFrames);
  const double bits = bits_of(encoded);
  return {std::move(candidate), std::move(analysis), error + lambda(step_) * bits, error, bits,
          encoded.components};
}

SkinnedTrial SkinnedTrials::run(SkinnedCandidate candidate,
                                const SkinnedAnalysis* before) const {
  candidate.settings.draft = true;
  SkinnedAnalysis analysis = analyse_candidate(context_, frames_, candidate, step_, before);
  return encode(std::move(candidate), std::move(analysis));
}

SkinnedTrial SkinnedTrials::whole(const SkinnedCandidate& candidate) const {
  SkinnedCandidate copy = candidate;
  copy.settings.draft = false;
  SkinnedAnalysis analysis = analyse_candidate(context_, frames_, copy, step_);
  return encode(std::move(copy), std::move(analysis));
}

SkinnedTrial SkinnedTrials::again(const SkinnedTrial& trial,
                                  const SkinnedSettings& settings) const {
  const SkinnedSettings& before = trial.candidate.settings;
  const bool same_analysis =
      settings.prediction == before.prediction && settings.layer_steps == before.layer_steps;
  SkinnedCandidate candidate{trial.candidate.rig, trial.candidate.counts, settings};
  candidate.settings.draft = true;
  SkinnedAnalysis analysis =
      same_analysis ? trial.analysis
                    : analyse_candidate(context_, frames_, candidate, step_, &trial.analysis);
  return encode(std::move(candidate), std::move(analysis));
}

BestTrial SkinnedTrials::with_settings(const SkinnedTrial& trial,
                                       const SkinnedSettings& settings) const {
  SkinnedTrial other = again(trial, settings);
  return other.cost < trial.cost ? BestTrial(std::move(other)) : std::nullopt;
}

EncodedSpan encode_skinned_gof(const SkinnedContext& context, const SkinnedAnalysis& analysis,
                               const SkinnedSettings& settings, double step,
                               bool has_followers) {
  const OrderedMesh& mesh = context.meshes[settings.prediction];
  CodedSpan coded = code_skinned_span(mesh, analysis, settings, step);
  const SpanUnits units(mesh, context.header, settings.temporal_layers);
  if (has_followers) return units.with_kept_rig(std::move(coded), analysis.rest);
  return coded.gofs.size() == 1 ? units.alone(std::move(coded))
                                : units.with_rig(std::move(coded));
}

}  // namespace rlpc
