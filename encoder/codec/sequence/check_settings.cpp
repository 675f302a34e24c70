#include "encoder/codec/sequence/check_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/kind_choices.h"
#include "encoder/codec/kinds/inter/check_frame_pattern.h"

namespace rlpc {
namespace {

struct Parameter {
  const char* setting;  // name in quotes, as messages have it
  bool given;           // differs from the default
};

// The structured binding names all members: a new member does not compile until it is added
// here.
std::vector<Parameter> parameters(const BaselineTools& tools) {
  const auto& [clusters, rdo, rate_in_vectors, qu, qc, qdelta, frame_mode, seed_mode, partition,
               motion] = tools;
  const BaselineTools defaults;
  return {{"'clusters'", clusters != defaults.clusters},
          {"'rdo = false'", rdo != defaults.rdo},
          {"'rate_in_vectors'", rate_in_vectors != defaults.rate_in_vectors},
          {"'qu'", qu != defaults.qu},
          {"'qc'", qc != defaults.qc},
          {"'qdelta'", qdelta != defaults.qdelta},
          {"'frame_mode'", frame_mode != defaults.frame_mode},
          {"'seed_mode'", seed_mode != defaults.seed_mode},
          {"'partition'", partition != defaults.partition},
          {"'motion'", motion != defaults.motion}};
}

std::optional<InputError> check_cuts(const std::vector<std::uint32_t>& cuts,
                                     std::uint32_t num_groups) {
  if (cuts.empty()) return std::nullopt;
  if (cuts.size() + 1 != num_groups) {
    return InputError{
        "'layer_cuts' needs a number of vertices for each cut, which are 1 fewer "
        "than 'layer_groups'"};
  }
  if (cuts[0] == 0 || !std::is_sorted(cuts.begin(), cuts.end(), std::less_equal<>())) {
    return InputError{
        "the numbers of 'layer_cuts' are at least 1, and each is greater than the "
        "one before"};
  }
  return std::nullopt;
}

std::vector<Parameter> parameters(const MainTools& tools) {
  const auto& [bones, prediction, influences, geometry_weights, outer_ring, layer_steps,
               temporal_weights, adaptive_factors, rest, track_levels, temporal_layers,
               cobra_steps, clusters, component_groups, layer_groups, layer_cuts] = tools;
  const MainTools defaults;
  return {{"'bones'", bones != defaults.bones},
          {"'prediction'", prediction != defaults.prediction},
          {"'influences'", influences != defaults.influences},
          {"'geometry_weights = false'", geometry_weights != defaults.geometry_weights},
          {"'outer_ring = false'", outer_ring != defaults.outer_ring},
          {"'layer_steps = false'", layer_steps != defaults.layer_steps},
          {"'temporal_weights = false'", temporal_weights != defaults.temporal_weights},
          {"'cobra_steps'", cobra_steps != defaults.cobra_steps},
          {"'clusters = false'", clusters != defaults.clusters},
          {"'component_groups'", component_groups != defaults.component_groups},
          {"'layer_groups'", layer_groups != defaults.layer_groups},
          {"'layer_cuts'", layer_cuts != defaults.layer_cuts}};
}

// Returns the parameters that the Main profile does not have.
std::vector<Parameter> parameters_of_high(const MainTools& tools) {
  const MainTools defaults;
  return {{"'adaptive_factors'", tools.adaptive_factors != defaults.adaptive_factors},
          {"'rest'", tools.rest != defaults.rest},
          {"'track_levels'", tools.track_levels != defaults.track_levels},
          {"'temporal_layers'", tools.temporal_layers != defaults.temporal_layers}};
}

// Rejects parameters of the other profile, which would have no effect.
std::optional<InputError> check_unused(const std::vector<Parameter>& parameters,
                                       const std::string& profile) {
  for (const Parameter& p : parameters) {
    if (p.given) {
      return InputError{std::string(p.setting) + " needs " + profile +
                        ": use that, or leave out " + p.setting};
    }
  }
  return std::nullopt;
}

// Returns the setting of a profile or those above it: "'profile = main' or high".
std::string profiles_with(std::uint32_t profile_idc) {
  constexpr std::array<const char*, 3> kWords{"baseline", "main", "high"};
  std::string words = std::string("'profile = ") + kWords[profile_idc] + "'";
  for (std::uint32_t p = profile_idc + 1; p < kWords.size(); ++p) {
    words += std::string(" or ") + kWords[p];
  }
  return words;
}

std::optional<InputError> check_low_delay(const EncoderSettings& s) {
  if (!s.low_delay) return std::nullopt;
  if (s.profile != Profile::kHigh) {
    return InputError{
        "low delay needs 'profile = high' (version 1.2, in preparation): use that, or leave "
        "out 'low_delay'"};
  }
  if (s.gof_kind.value_or(GofKind::kInter) != GofKind::kInter) {
    return InputError{"low delay needs inter GOFs: leave out 'gof_kind'"};
  }
  if (s.target.kind == Target::kBpvf) {
    return InputError{
        "without a delay, a rate cannot be searched for: use 'target = kg', "
        "'target = max_error' or 'target = lossless, target_value = BITS' instead of "
        "'target = bpvf'"};
  }
  const FramePattern::Kind pattern = s.inter.pattern.value_or(FramePattern{}).kind;
  if (pattern != FramePattern::kPrevious && pattern != FramePattern::kFirst) {
    return InputError{
        "low delay needs frames that are coded in their order: use 'pattern = previous' or "
        "first"};
  }
  return std::nullopt;
}

std::optional<InputError> check_pattern(const EncoderSettings& s) {
  const std::uint32_t layers = s.inter.temporal_layers;
  if (!s.inter.pattern && !s.low_delay) {
    constexpr std::uint32_t kMax = kMaxPatternPeriodLog2 + 1;  // fixed: format
    if (layers >= 1 && layers <= kMax) return std::nullopt;
    return InputError{"without 'pattern', there are 1 to " + std::to_string(kMax) +
                      " temporal layers ('temporal_layers')"};
  }
  FramePattern pattern = s.inter.pattern.value_or(FramePattern{});
  pattern.temporal_layers = layers;
  if (auto error = error_of_pattern(pattern)) return InputError{*error};
  return std::nullopt;
}

std::optional<InputError> check_choice_of_kind(const EncoderSettings& s) {
  if (!s.gof_kind) return std::nullopt;
  if (!can_be_chosen(*s.gof_kind)) {
    return InputError{"shared rigs cannot be chosen: use 'gof_kind = skinned'"};
  }
  const KindProperties& kind = properties_of(*s.gof_kind);
  if (kind.profile_idc <= static_cast<std::uint32_t>(s.profile)) return std::nullopt;
  return InputError{std::string(kind.name) + " GOFs need " + profiles_with(kind.profile_idc) +
                    ": use that, or leave out 'gof_kind'"};
}

std::optional<InputError> check_kinds(const EncoderSettings& s) {
  if (auto error = check_choice_of_kind(s)) return error;
  if (s.target.kind == Target::kLossless) {
    if (s.profile != Profile::kHigh) {
      return InputError{
          "lossless coding needs 'profile = high' (version 1.2, in preparation): use that, or "
          "leave out 'target = lossless'"};
    }
    if (s.gof_kind.value_or(GofKind::kInter) != GofKind::kInter) {
      return InputError{
          "only inter GOFs are lossless: use 'gof_kind = inter', or leave out 'gof_kind' or "
          "'target = lossless'"};
    }
  }
  if (auto error = check_low_delay(s)) return error;
  const std::optional<GofKind> kind = s.usable_kind();
  if (kind == GofKind::kInter && s.components > 0) {
    return InputError{"'components' has no effect on inter GOFs: leave it out"};
  }
  if (!s.may_use(GofKind::kSkinned) && s.main != MainTools{}) {
    return InputError{
        "the settings of bones and trajectories have no effect on GOFs without "
        "bones: leave them out, or use 'gof_kind = auto' or skinned"};
  }
  if (auto error = check_pattern(s)) return error;
  if (!kind && (s.inter.temporal_layers > 1 || s.inter.layer_groups > 1)) {
    return InputError{
        "layers of inter GOFs need GOFs of this kind alone: use 'gof_kind = inter'"};
  }
  if (s.inter.layer_groups < 1) return InputError{"there is at least one layer group"};
  if (auto error = check_cuts(s.main.layer_cuts, s.main.layer_groups)) return error;
  if (auto error = check_cuts(s.inter.layer_cuts, s.inter.layer_groups)) return error;
  if (s.inter != InterTools{} && !(s.may_use(GofKind::kInter) && s.profile == Profile::kHigh)) {
    return InputError{
        "'pattern', 'weights', 'patches' and, except for Baseline, 'partition' need "
        "'profile = high' and 'gof_kind = inter': use these, or leave them out"};
  }
  return std::nullopt;
}

// Rejects parameters of layers if there are no layers, as they would have no effect.
std::optional<InputError> check_layers(const MainTools& tools) {
  if (tools.prediction.value_or(Prediction::kLayers) == Prediction::kLayers)
    return std::nullopt;
  const MainTools defaults;
  for (const Parameter& p :
       {Parameter{"'geometry_weights = false'",
                  tools.geometry_weights != defaults.geometry_weights},
        Parameter{"'outer_ring = false'", tools.outer_ring != defaults.outer_ring},
        Parameter{"'layer_steps = false'", tools.layer_steps != defaults.layer_steps},
        Parameter{"'layer_groups'", tools.layer_groups > 1}}) {
    if (p.given) {
      return InputError{std::string(p.setting) +
                        " needs layers: leave it out, or use 'prediction = layers'"};
    }
  }
  return std::nullopt;
}

std::optional<InputError> check_baseline(const EncoderSettings& s) {
  const BaselineTools& b = s.baseline;
  if ((b.qu == 0) != (b.qc == 0)) {
    return InputError{"qu and qc go together: give both, or neither"};
  }
  if (b.qu > 0 && s.target.kind != Target::kNone) {
    return InputError{
        "a target determines the quantisers: leave out either the target or qu and qc"};
  }
  if (b.qu > 0 && s.components == 0) {
    return InputError{"qu and qc need a number of components per cluster ('components')"};
  }
  if ((!b.rdo || b.rate_in_vectors) && s.components == 0) {
    return InputError{std::string(b.rdo ? "'rate_in_vectors'" : "'rdo = false'") +
                      " needs a number of components per cluster ('components')"};
  }
  const bool needs_seeds = b.motion != MotionMeasure::kAuto || b.seed_mode == SeedMode::kFirst;
  if (needs_seeds && b.partition != PartitionMethod::kSeeds) {
    return InputError{
        std::string(b.motion != MotionMeasure::kAuto ? "'motion'" : "'seed_mode = first'") +
        " needs clusters of seeds: leave it out, or use 'partition = seeds'"};
  }
  if (b.qu < 0 || b.qc < 0 || b.qdelta < 0 || b.qu > 20 || b.qc > 20 || b.qdelta > 24) {
    return InputError{"quantisers have at most 20 bits (qu, qc) and 24 bits (qdelta)"};
  }
  return std::nullopt;
}

// Rejects counts that exceed the limits of every level (Annex B), whatever the animation.
std::optional<InputError> check_counts(const EncoderSettings& s) {
  const Level& top = kLevels.back();
  const auto refuse = [](std::uint32_t limit, const std::string& what) {
    return InputError{"no level allows more than " + std::to_string(limit) + " " + what};
  };
  if (s.components > top.max_components) {
    return refuse(top.max_components, "components ('components')");
  }
  if (s.main.bones > top.max_clusters) return refuse(top.max_clusters, "bones ('bones')");
  if (s.baseline.clusters > top.max_clusters) {
    return refuse(top.max_clusters, "clusters ('clusters')");
  }
  return std::nullopt;
}

bool is_position_bits(double value) {
  return value >= kMinPositionBits && value <= kMaxPositionBits && value == std::floor(value);
}

}  // namespace

std::optional<InputError> check_clips(std::span<const Clip> clips, std::uint32_t num_frames) {
  if (clips.size() > kMaxClips) {
    return InputError{"a stream has at most " + std::to_string(kMaxClips) + " clips, not " +
                      std::to_string(clips.size())};
  }
  for (const Clip& clip : clips) {
    if (clip.name.empty() || clip.name.size() > kMaxClipNameBytes ||
        find_clip_name_error(clip.name) < clip.name.size()) {
      return InputError{"the name of a clip has 1 to " + std::to_string(kMaxClipNameBytes) +
                        " bytes of UTF-8 without control characters ('clips')"};
    }
    if (clip.num_frames == 0) return InputError{"clip `" + clip.name + "` has no frames"};
    if (clip.first_frame >= num_frames || clip.num_frames > num_frames - clip.first_frame) {
      return InputError{"clip `" + clip.name + "` has frames beyond the last, " +
                        std::to_string(num_frames - 1) + " ('clips')"};
    }
  }
  return std::nullopt;
}

std::optional<InputError> check_attributes(const AttributeSettings& settings,
                                           const SourceAttributes& attributes) {
  const auto& sets = attributes.sets;
  if (settings.dropped || sets.size() <= kMaxAttributeSets) return std::nullopt;
  return InputError{"a stream has at most " + std::to_string(kMaxAttributeSets) +
                    " attributes, not " + std::to_string(sets.size()) + ": leave out `" +
                    sets[kMaxAttributeSets].name +
                    (sets.size() > kMaxAttributeSets + 1 ? "` and those after it" : "`")};
}

std::optional<InputError> check_settings(const EncoderSettings& s) {
  const bool main = s.profile != Profile::kBaseline;
  if (auto error = main ? check_unused(parameters(s.baseline), "'profile = baseline'")
                        : check_unused(parameters(s.main), "'profile = main'")) {
    return error;
  }
  if (s.profile != Profile::kHigh) {
    if (auto error = check_unused(parameters_of_high(s.main), "'profile = high'")) return error;
  }
  if (auto error = check_kinds(s)) return error;
  if (auto error = check_baseline(s)) return error;
  if (auto error = check_layers(s.main)) return error;
  if (auto error = check_counts(s)) return error;
  if (s.main.track_levels.value_or(0) > std::uint32_t{kMaxTrackLevels}) {
    return InputError{"hierarchical tracks have at most " + std::to_string(kMaxTrackLevels) +
                      " levels besides level 0 ('track_levels')"};
  }
  const std::uint32_t max_layers = s.main.track_levels.value_or(kMaxTrackLevels) + 1;
  if (s.main.temporal_layers < 1 || s.main.temporal_layers > max_layers) {
    return InputError{"with " + std::to_string(max_layers - 1) +
                      " track levels, there are 1 to " + std::to_string(max_layers) +
                      " temporal layers ('temporal_layers')"};
  }
  // A vertex none of whose bones is a candidate has at most these (6.12.2).
  if (s.main.influences > kMaxExtraBones) {
    return InputError{"a vertex follows at most " + std::to_string(kMaxExtraBones) +
                      " bones ('influences')"};
  }
  if (s.metadata.size() > kMaxMetadataBytes) {
    return InputError{"metadata may have at most 1 MiB"};
  }
  if (auto error = check_clips(s.clips, kMaxFrames)) return error;
  if (s.target.has_search() && !(s.target.value > 0.0 && std::isfinite(s.target.value))) {
    return InputError{"a target must be a number above zero"};
  }
  if (!(s.target.max_normals >= 0.0 && std::isfinite(s.target.max_normals))) {
    return InputError{"a bound of vertex normals must be a number of degrees, above zero"};
  }
  if (s.target.max_normals > 0.0 && (s.target.kind != Target::kKg || s.low_delay)) {
    return InputError{
        "vertex normals are bounded only with 'target = kg', and not with 'low_delay': leave "
        "out 'max_normals'"};
  }
  if (s.target.kind == Target::kLossless && s.target.value != 0.0 &&
      !is_position_bits(s.target.value)) {
    return InputError{"positions have 2 to " + std::to_string(kMaxPositionBits) +
                      " bits ('target = lossless')"};
  }
  return std::nullopt;
}

}  // namespace rlpc
