#include "encoder/skinned_gof/search/skinned_trial.h"

#include <memory>
#include <span>
#include <utility>

#include "common/skinned_gof/recon/skinned_recon.h"
#include "encoder/gof/lagrangian.h"
#include "encoder/skinned_gof/quantise/skinned_gof_encoder.h"
#include "encoder/write/write_skinned_gof.h"

namespace rlpc {

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
    usual.num_adaptive_factors = tools.adaptive_factors.value_or(kLevels.back().max_components);
  }
  if (settings.preset == Preset::kFast) usual.rounding = Rounding::kDeadZone;
  if (settings.target.kind == Target::kMaxError) usual.rounding = Rounding::kNearest;
  usual.temporal_weights = tools.temporal_weights;
  usual.cobra_steps = tools.cobra_steps;
  usual.component_groups = tools.component_groups;
  usual.layer_groups = tools.layer_groups;
  usual.max_trajectories = kLevels.back().max_components;
  if (settings.components > 0) usual.max_trajectories = settings.components;
  return usual;
}

BestTrial cheaper(BestTrial before, SkinnedTrial trial) {
  if (before && !(trial.cost < before->cost)) return before;
  return trial;
}

SkinnedAnalysis SkinnedTrials::analyse(const SkinnedCandidate& candidate,
                                       const SkinnedAnalysis* same_bones) const {
  return analyse_skinned_gof(context_.meshes[candidate.settings.prediction],
                             context_.header.position_bits, frames_, candidate.rig,
                             candidate.settings, step_, same_bones);
}

double SkinnedTrials::cost(const SkinnedAnalysis& analysis,
                           const SkinnedSettings& settings) const {
  return lagrangian_cost(encode_skinned_gof(context_, analysis, settings, step_), frames_,
                         step_);
}

SkinnedTrial SkinnedTrials::run(SkinnedCandidate candidate) const {
  SkinnedAnalysis analysis = analyse(candidate);
  const double candidate_cost = cost(analysis, candidate.settings);
  return {std::move(candidate), std::move(analysis), candidate_cost};
}

SkinnedTrial SkinnedTrials::with_settings(SkinnedTrial trial,
                                          const SkinnedSettings& settings) const {
  const SkinnedSettings& before = trial.candidate.settings;
  const bool same_analysis =
      settings.prediction == before.prediction && settings.layer_steps == before.layer_steps;
  if (!same_analysis) {
    SkinnedCandidate candidate{trial.candidate.rig, trial.candidate.counts, settings};
    SkinnedAnalysis analysis = analyse(candidate, &trial.analysis);
    const double other_cost = cost(analysis, settings);
    if (other_cost >= trial.cost) return trial;
    return {std::move(candidate), std::move(analysis), other_cost};
  }
  const double other_cost = cost(trial.analysis, settings);
  if (other_cost < trial.cost) {
    trial.cost = other_cost;
    trial.candidate.settings = settings;
  }
  return trial;
}

EncodedGof encode_skinned_gof(const SkinnedContext& context, const SkinnedAnalysis& analysis,
                              const SkinnedSettings& settings, double step) {
  const CodedMesh& mesh = context.meshes[settings.prediction];
  const int position_bits = context.header.position_bits;
  const SkinnedGof gof = code_skinned_gof(mesh, analysis, settings, step);
  EncodedGof encoded;
  SkinnedGofPayloads payloads = write_skinned_gof(gof, mesh, context.header);
  encoded.units.push_back({UnitType::kGof, std::move(payloads.gof)});
  for (auto& slice : payloads.slices) {
    encoded.units.push_back({UnitType::kSlice, std::move(slice)});
  }
  const auto recon = std::make_shared<SkinnedRecon>(mesh, gof, position_bits);
  encoded.frame = [recon](std::uint32_t f, std::span<std::int32_t> positions) {
    recon->frame(f, positions);
  };
  encoded.clusters = static_cast<std::uint32_t>(gof.bones.size());
  encoded.components = static_cast<std::uint32_t>(gof.trajectories.size());
  encoded.max_components = encoded.components;
  encoded.num_factors =
      6 * std::uint64_t{gof.bones.size()} * gof.num_frames +
      3 * std::uint64_t{mesh.num_vertices()} +
      gof.trajectories.size() * (mesh.num_vertices() + 3 * std::uint64_t{gof.num_frames});
  return encoded;
}

}  // namespace rlpc
