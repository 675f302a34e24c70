#include "encoder/skinned_gof/search/skinned_trial.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "common/skinned_gof/recon/skinned_recon.h"
#include "encoder/gof/lagrangian.h"
#include "encoder/skinned_gof/quantise/skinned_gof_encoder.h"
#include "encoder/skinned_gof/search/temporal_cut.h"
#include "encoder/write/write_skinned_gof.h"

namespace rlpc {
namespace {

// tuned (off: 0): Levels of hierarchical tracks besides level 0, with the High profile. Each
// level more doubles the distance over which level 0 is predicted.
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
  usual.max_trajectories = kLevels.back().max_components;
  if (settings.components > 0) usual.max_trajectories = settings.components;
  return usual;
}

BestTrial cheaper(BestTrial before, SkinnedTrial trial) {
  if (before && !(trial.cost < before->cost)) return before;
  return trial;
}

SkinnedAnalysis analyse_candidate(const SkinnedContext& context, const GofFrames& frames,
                                  const SkinnedCandidate& candidate, double step,
                                  const SkinnedAnalysis* before) {
  return analyse_skinned_gof(context.meshes[candidate.settings.prediction],
                             context.header.position_bits, frames, candidate.rig,
                             candidate.settings, step, before);
}

SkinnedTrial SkinnedTrials::encode(SkinnedCandidate candidate, SkinnedAnalysis analysis) const {
  const EncodedGof encoded = encode_skinned_gof(context_, analysis, candidate.settings, step_);
  const double error = squared_error(frames_, encoded.frame, kErrorFrames);
  return {std::move(candidate), std::move(analysis), error + lambda(step_) * bits_of(encoded),
          error, encoded.components};
}

SkinnedTrial SkinnedTrials::run(SkinnedCandidate candidate,
                                const SkinnedAnalysis* before) const {
  candidate.settings.draft = true;
  SkinnedAnalysis analysis = analyse_candidate(context_, frames_, candidate, step_, before);
  return encode(std::move(candidate), std::move(analysis));
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

namespace {

void add_units(SkinnedGofPayloads payloads, UnitType first, EncodedGof& encoded) {
  encoded.units.push_back({first, std::move(payloads.first)});
  for (std::size_t i = 0; i < payloads.slices.size(); ++i) {
    encoded.units.push_back(
        {UnitType::kSlice, std::move(payloads.slices[i]), payloads.temporal_layer_idx[i]});
  }
}

DecodeFrame frames_of(std::shared_ptr<const SkinnedRecon> recon) {
  return [recon = std::move(recon)](std::uint32_t f, std::span<std::int32_t> positions) {
    recon->frame(f, positions);
  };
}

// GOFs one after the other.
DecodeFrame frames_of(std::vector<std::shared_ptr<const SkinnedRecon>> recons) {
  return [recons = std::move(recons)](std::uint32_t f, std::span<std::int32_t> positions) {
    auto recon = recons.begin();
    while (f >= (*recon)->num_frames()) f -= (*recon++)->num_frames();
    (*recon)->frame(f, positions);
  };
}

// A GOF with vertices of its own.
DecodeFrame encode_alone(const CodedMesh& mesh, const SequenceHeader& header, CodedSpan coded,
                         int temporal_layers, EncodedGof& encoded) {
  auto gof = std::make_shared<SkinnedGof>(merge_into_gof(std::move(coded)));
  set_temporal_layers(temporal_layers, *gof);
  add_units(write_skinned_gof(*gof, mesh, header), UnitType::kGof, encoded);
  if (temporal_layers > 1) {
    encoded.cut = [&mesh, gof, position_bits = header.position_bits](int layers) {
      return frames_of(
          std::make_shared<SkinnedRecon>(mesh, without_layers(*gof, layers), position_bits));
    };
  }
  return frames_of(std::make_shared<SkinnedRecon>(mesh, *gof, header.position_bits));
}

// A skinned model and GOFs of tracks.
DecodeFrame encode_with_model(const CodedMesh& mesh, const SequenceHeader& header,
                              CodedSpan coded, int temporal_layers, EncodedGof& encoded) {
  const auto model = std::make_shared<const SkinnedModel>(std::move(coded.model));
  add_units(write_skinned_model(*model, kModelIdx, mesh, header), UnitType::kModel, encoded);
  const auto shared =
      std::make_shared<const ModelRecon>(mesh, *model, header.position_bits, false);
  std::vector<std::shared_ptr<const SkinnedRecon>> recons;
  for (SkinnedGof& gof : coded.gofs) {
    use_model(model, gof);
    set_temporal_layers(temporal_layers, gof);
    add_units(write_tracks(gof, mesh, header), UnitType::kGof, encoded);
    recons.push_back(std::make_shared<SkinnedRecon>(shared, gof));
  }
  if (temporal_layers > 1) {
    encoded.cut = [shared, gofs = std::move(coded.gofs)](int layers) {
      std::vector<std::shared_ptr<const SkinnedRecon>> cut;
      for (const SkinnedGof& gof : gofs) {
        cut.push_back(std::make_shared<SkinnedRecon>(shared, without_layers(gof, layers)));
      }
      return frames_of(std::move(cut));
    };
  }
  return frames_of(std::move(recons));
}

}  // namespace

EncodedGof encode_skinned_gof(const SkinnedContext& context, const SkinnedAnalysis& analysis,
                              const SkinnedSettings& settings, double step) {
  const CodedMesh& mesh = context.meshes[settings.prediction];
  CodedSpan coded = code_skinned_span(mesh, analysis, settings, step);
  const std::uint64_t num_vertices = mesh.num_vertices();
  const std::uint64_t num_bones = coded.model.bones.size();
  const std::uint64_t num_trajectories = coded.model.trajectories.size();
  std::uint32_t longest = 0;
  for (const SkinnedGof& gof : coded.gofs) longest = std::max(longest, gof.num_frames);
  EncodedGof encoded;
  encoded.clusters = static_cast<std::uint32_t>(num_bones);
  encoded.max_clusters = encoded.clusters;
  encoded.components = static_cast<std::uint32_t>(num_trajectories);
  encoded.max_components = encoded.components;
  encoded.num_factors = (kRestFactors + num_trajectories) * num_vertices +
                        (6 * num_bones + 3 * num_trajectories) * longest;
  encoded.adaptive_values = coded.model.weights.num_adaptive_factors * num_vertices;
  encoded.frame = coded.gofs.size() == 1
                      ? encode_alone(mesh, context.header, std::move(coded),
                                     settings.temporal_layers, encoded)
                      : encode_with_model(mesh, context.header, std::move(coded),
                                          settings.temporal_layers, encoded);
  return encoded;
}

}  // namespace rlpc
