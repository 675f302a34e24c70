#include "encoder/skinned_gof/search/skinned_gof_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/skinned_gof/recon/skinned_recon.h"
#include "common/syntax/sequence_header.h"
#include "encoder/skinned_gof/fit/bone_fit.h"
#include "encoder/write/write_skinned_gof.h"

namespace rlpc {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kMinVerticesOfBone = 8;
constexpr std::uint32_t kUsualInfluences = 4;
constexpr std::uint32_t kSmallMesh = 1000;  // of which everything is tried
// Bones are looked for with vertices that follow one, and with vertices that follow two: with
// more, bones overlap, and neither they nor weights are smooth.
constexpr std::uint32_t kSearchInfluences = 2;
// Parts of the error of one bone that does not turn which one that turns leaves: below the
// first, that is chosen unseen; above the second, the one which does not turn.
constexpr double kRigidPart = 0.5;
constexpr double kFlexiblePart = 1.0;
// Expected costs at which bones are looked for: relative to those expected without bones, to
// the real ones without, and to the real ones once the first bones are there. If the first are
// very low, nothing else is tried.
constexpr double kTryFactor = 0.72;
constexpr double kTryFactorOfReal = 0.85;
constexpr double kTryFactorUnsettled = 0.93;
constexpr double kTryFactorSettled = 0.9;
constexpr double kSure = 0.3;
// Below this part of the cost expected without bones, expected costs are trusted more than the
// real one: what makes that low, such as vertices at rest, is there with bones, too.
constexpr double kStrongEstimate = 0.5;
// Limits of promises are so much higher where a trial takes little time.
constexpr double kHopeOfSmallMesh = 1.35;
constexpr double kHopeOfFewValues = 1.07;
constexpr std::uint64_t kFewValues = 200'000;  // vertices times frames
// Expected costs, relative to the least, of numbers of bones to be tried.
constexpr double kNearLeast = 1.06;
constexpr double kWorthACost = 1.2;
constexpr double kFarAbove = 1.1;  // real costs that rise here will not fall again
// So many bones tell whether more are worth looking at: not above this expected cost.
constexpr std::uint32_t kEnoughBones = 20;
constexpr double kHopeless = 0.92;

// Numbers of bones worth comparing.
constexpr std::array<std::uint32_t, 4> kFewBones{10, 20, 28, 36};
constexpr std::array<std::uint32_t, 9> kManyBones{5, 10, 15, 20, 24, 28, 36, 48, 64};

const CodedMesh& mesh_of(const SkinnedContext& context, Prediction prediction) {
  return context.meshes[static_cast<std::size_t>(prediction)];
}

EncodedGof encoded_gof(const SkinnedContext& context, const SkinnedGof& gof) {
  EncodedGof encoded;
  const CodedMesh& mesh = mesh_of(context, gof.prediction);
  SkinnedGofPayloads payloads = write_skinned_gof(gof, mesh, context.position_bits);
  encoded.units.push_back({UnitType::kGof, std::move(payloads.gof)});
  for (auto& slice : payloads.slices) {
    encoded.units.push_back({UnitType::kSlice, std::move(slice)});
  }
  const auto recon = std::make_shared<SkinnedRecon>(mesh, gof, context.position_bits);
  encoded.frame = [recon](std::uint32_t f, std::span<std::int32_t> positions) {
    recon->frame(f, positions);
  };
  encoded.clusters = static_cast<std::uint32_t>(gof.bones.size());
  encoded.components = static_cast<std::uint32_t>(gof.trajectories.size());
  encoded.most_components = encoded.components;
  encoded.num_factors =
      6 * std::uint64_t{gof.bones.size()} * gof.num_frames +
      3 * std::uint64_t{mesh.num_vertices()} +
      gof.trajectories.size() * (mesh.num_vertices() + 3 * std::uint64_t{gof.num_frames});
  return encoded;
}

double threshold_factor_of(const GofFrames& frames) {
  if (frames.num_vertices <= kSmallMesh) return kHopeOfSmallMesh;
  const std::uint64_t values = std::uint64_t{frames.num_vertices} * frames.num_frames;
  return values <= kFewValues ? kHopeOfFewValues : 1.0;
}

// One bone that does not turn: it follows the centre of the vertices.
Rig translation_rig(const GofFrames& frames) {
  Rig rig;
  const double n = frames.num_vertices;
  rig.bones.resize(1);
  rig.bones[0].turns = false;
  rig.rest.assign(frames.num_vertices, Point{});
  rig.weights.assign(frames.num_vertices, {RigWeight{}});
  for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
    RigPose pose;
    for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
      for (std::size_t c = 0; c < 3; ++c) pose.origin[c] += frames.at(f, v)[c] / n;
    }
    for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        rig.rest[v][c] += (frames.at(f, v)[c] - pose.origin[c]) / frames.num_frames;
      }
    }
    rig.bones[0].poses.push_back(pose);
  }
  return rig;
}

}  // namespace

SkinnedGofSearch::SkinnedGofSearch(const SkinnedContext& context, const GofFrames& frames,
                                   std::uint32_t first_frame, const EncoderSettings& settings,
                                   std::optional<SkinnedChoice>& choice)
    : context_(context),
      frames_(frames),
      first_frame_(first_frame),
      tools_(settings.main),
      preset_(settings.preset),
      threshold_factor_(threshold_factor_of(frames)),
      max_influences_(tools_.influences == 0 ? kUsualInfluences : tools_.influences),
      choice_(choice) {
  if (tools_.layer_groups > 1) tools_.prediction = Prediction::kLayers;
  usual_.prediction = tools_.prediction.value_or(Prediction::kLayers);
  if (!tools_.geometry_weights) usual_.damping_log2 = 0;
  if (!tools_.outer_ring) usual_.outer_weight = 0;
  if (!tools_.outer_ring) usual_.outer_scale = 0;
  usual_.layer_steps = tools_.layer_steps;
  if (preset_ == Preset::kFast) usual_.rounding = Rounding::kDeadZone;
  if (settings.target.kind == Target::kMaxError) usual_.rounding = Rounding::kNearest;
  usual_.temporal_weights = tools_.temporal_weights;
  usual_.cobra_steps = tools_.cobra_steps;
  usual_.component_groups = tools_.component_groups;
  usual_.layer_groups = tools_.layer_groups;
  usual_.max_trajectories = kLevels.back().max_components;
  if (settings.components > 0) usual_.max_trajectories = settings.components;
}

SkinnedAnalysis SkinnedGofSearch::analyse(const SkinnedChoice& choice, double step) const {
  return analyse_skinned_gof(mesh_of(context_, choice.settings.prediction),
                             context_.position_bits, frames_, first_frame_, choice.rig,
                             choice.settings, step);
}

SkinnedGof SkinnedGofSearch::code(const SkinnedAnalysis& analysis,
                                  const SkinnedSettings& settings, double step) const {
  return code_skinned_gof(mesh_of(context_, settings.prediction), analysis, settings, step);
}

double SkinnedGofSearch::cost(const SkinnedAnalysis& analysis, const SkinnedSettings& settings,
                              double step) const {
  return lagrangian_cost(encoded_gof(context_, code(analysis, settings, step)), frames_, step);
}

BoneFit SkinnedGofSearch::fit(std::size_t influences, double step) const {
  return {frames_, context_.triangles, {.max_influences = influences, .step = step}};
}

// From a small sample.
BoneFit SkinnedGofSearch::quick_fit(std::size_t influences, double step) const {
  return {frames_,
          context_.triangles,
          {.max_influences = influences,
           .step = step,
           .sample_frames = 24,
           .sample_vertices = 700,
           .exchanges = 2}};
}

// One bone that turns, if that makes much of a difference, else one that does not.
void SkinnedGofSearch::choose_one_bone() {
  const BoneFit quick = quick_fit(1, choice_->step);
  const double translation = quick.translation_error();
  const double part =
      translation > 0.0 ? quick.rms_error() / translation : 1.0;  // nothing moves
  if (preset_ == Preset::kFast) {
    choice_->rig = part < kRigidPart ? quick.rig(1) : translation_rig(frames_);
    return;
  }
  const bool slow = preset_ == Preset::kSlow;
  if (slow || part >= kRigidPart) consider(translation_rig(frames_), {});
  if (slow || part < kFlexiblePart) consider(quick.rig(1), {});
}

// The numbers of bones that a small sample promises most of, with vertices that follow so many.
SkinnedGofSearch::BoneEstimate SkinnedGofSearch::estimate(std::size_t influences,
                                                          double step) const {
  BoneEstimate best;
  BoneFit quick = quick_fit(influences, step);
  best.translation = quick.expected_translation_cost();
  for (const std::uint32_t count : kFewBones) {
    if (!grow(quick, count)) break;
    const double expected = quick.expected_cost();
    best.costs.push_back(expected);
    if (expected < best.cost) {
      best.cost = expected;
      best.count = count;
    }
    if (count >= kEnoughBones && best.cost > kHopeless * best.translation) break;
  }
  return best;
}

// Takes a rig if it costs less than the one before, with its analysis.
double SkinnedGofSearch::consider(Rig rig, const BoneCounts& counts) {
  SkinnedChoice other{std::move(rig), counts, usual_, choice_->step, choice_->times};
  SkinnedAnalysis analysis = analyse(other, other.step);
  const double now = cost(analysis, other.settings, other.step);
  if (now < least_) {
    least_ = now;
    cached_ = Cached{other.step, std::move(analysis)};
    choice_ = std::move(other);
  }
  return now;
}

// The same of tools.
void SkinnedGofSearch::consider(const SkinnedSettings& settings) {
  SkinnedChoice other{choice_->rig, choice_->counts, settings, choice_->step, choice_->times};
  const bool same_analysis = settings.prediction == choice_->settings.prediction &&
                             settings.layer_steps == choice_->settings.layer_steps;
  SkinnedAnalysis analysis =
      same_analysis ? std::move(cached_->analysis) : analyse(other, other.step);
  const double now = cost(analysis, settings, other.step);
  if (now < least_) {
    least_ = now;
    choice_ = std::move(other);
  } else if (!same_analysis) {
    return;
  }
  cached_ = Cached{choice_->step, std::move(analysis)};
}

// Geometry weights cost more than they bring where rest positions tell little, and
// parallelograms predict regular meshes of few vertices better. Where bones leave little to
// predict, rest positions cost less without layers.
void SkinnedGofSearch::choose_prediction() {
  const auto try_other = [&](auto SkinnedSettings::*member, auto value) {
    SkinnedSettings other = choice_->settings;
    if (other.*member == value) return;
    other.*member = value;
    consider(other);
  };
  const bool slow = preset_ == Preset::kSlow;
  const bool small = frames_.num_vertices <= kSmallMesh;
  if (choice_->settings.prediction == Prediction::kLayers) {
    if (tools_.geometry_weights) try_other(&SkinnedSettings::damping_log2, 0);
    if (tools_.layer_steps && (slow || small)) try_other(&SkinnedSettings::layer_steps, false);
  }
  if (!tools_.prediction && choice_->rig.bones.size() > 1) {
    try_other(&SkinnedSettings::prediction, Prediction::kNone);
  }
  if (!tools_.prediction && (slow || small)) {
    try_other(&SkinnedSettings::prediction, Prediction::kParallelogram);
    try_other(&SkinnedSettings::prediction, Prediction::kParallelograms);
  }
}

void SkinnedGofSearch::choose(double step) {
  const SkinnedChoice before = std::move(choice_).value_or(SkinnedChoice{});
  choice_ = SkinnedChoice{{}, {}, usual_, step, before.times + 1};
  cached_.reset();
  if (preset_ == Preset::kFast && tools_.bones == 0) {
    choose_one_bone();
    return;
  }
  least_ = kNone;
  if (before.counts.bones > 0 && preset_ != Preset::kSlow) {
    choose_bones_near(before.counts, step < before.step);
  } else {
    choose_bones();
  }
  if (choice_->rig.bones.empty()) choose_one_bone();
  choose_prediction();
}

// As many bones as were best for another step, or the next number: more for a finer step,
// fewer, and after the fewest one, for a coarser.
void SkinnedGofSearch::choose_bones_near(const BoneCounts& counts, bool finer) {
  const auto at = std::find(kFewBones.begin(), kFewBones.end(), counts.bones);
  const auto first = finer || at == kFewBones.begin() ? at : at - 1;
  const auto end = finer ? std::min(at + 2, kFewBones.end()) : at + 1;
  if (!finer && first == kFewBones.begin()) choose_one_bone();
  BoneFit full = fit(counts.influences, choice_->step);
  if (!grow(full, *first)) return;
  try_bones(full, counts.influences, std::span(first, end), counts.bones);
}

void SkinnedGofSearch::choose_bones() {
  const double step = choice_->step;
  const std::uint32_t most = std::min(kSearchInfluences, max_influences_);
  if (tools_.bones > 0) {
    for (std::uint32_t influences = 1; influences <= most; ++influences) {
      BoneFit full = fit(influences, step);
      full.grow(tools_.bones);
      full.settle();
      consider(full.rig(influences == 1 ? 1 : max_influences_), {});
    }
    return;
  }
  // What does not estimate much with two influences does so less with one.
  std::array<BoneEstimate, kSearchInfluences> promises;
  double least = kNone;
  double translation = 0.0;
  for (std::uint32_t influences = most; influences > 0; --influences) {
    const BoneEstimate of = estimate(influences, step);
    translation = of.translation;
    if (of.cost > std::min(threshold_factor_ * kTryFactor * of.translation, kNearLeast * least))
      break;
    promises[influences - 1] = of;
    least = std::min(least, of.cost);
  }
  double without = translation;
  if (least > kSure * translation || preset_ == Preset::kSlow) {
    choose_one_bone();
    without = least_;
  }
  for (std::uint32_t influences = 1; influences <= most; ++influences) {
    const BoneEstimate& of = promises[influences - 1];
    const bool strong = of.cost < kStrongEstimate * of.translation;
    const double against = strong ? std::max(without, of.translation) : without;
    if (of.cost <=
        std::min(kNearLeast * least, threshold_factor_ * kTryFactorOfReal * against)) {
      try_estimated_bones(influences, of, against);
    }
    if (preset_ == Preset::kSlow) {
      BoneFit full = fit(influences, step);
      if (!grow(full, kManyBones.front())) break;
      try_bones(full, influences, kManyBones, kManyBones.back());
    }
  }
}

// About as many bones as are likely the best, unless the sample was too small to tell.
void SkinnedGofSearch::try_estimated_bones(std::uint32_t influences,
                                           const BoneEstimate& estimate, double without) {
  BoneFit full = fit(influences, choice_->step);
  std::size_t first = 0;
  const auto estimate_exceeds = [&](double part) {
    const double correction = full.expected_cost() / estimate.costs[first];
    return correction * estimate.cost < threshold_factor_ * part * without;
  };
  do {
    if (!can_have(kFewBones[first]) || !full.grow(kFewBones[first])) return;
    if (!estimate_exceeds(kTryFactorUnsettled)) return;
    full.settle();
    if (!estimate_exceeds(kTryFactorSettled)) return;
  } while (2 * kFewBones[first] < estimate.count && ++first < estimate.costs.size());
  try_bones(full, influences, std::span(kFewBones).subspan(first), estimate.count);
}

bool SkinnedGofSearch::can_have(std::uint32_t count) const {
  return count * kMinVerticesOfBone <= frames_.num_vertices;
}

bool SkinnedGofSearch::grow(BoneFit& fit, std::uint32_t count) const {
  if (!can_have(count) || !fit.grow(count)) return false;
  fit.settle();
  return true;
}

// Growing numbers of bones, of which the first are there, until the cost rises beyond the
// number that is likely the best.
void SkinnedGofSearch::try_bones(BoneFit& full, std::uint32_t influences,
                                 std::span<const std::uint32_t> counts, std::uint32_t likely) {
  double expected = kNone;
  double before = kNone;
  for (const std::uint32_t count : counts) {
    if (count != counts.front() && !grow(full, count)) break;
    const double now = full.expected_cost();
    expected = std::min(expected, now);
    if (now > threshold_factor_ * kWorthACost * expected) continue;
    const double real =
        consider(full.rig(influences == 1 ? 1 : max_influences_), {count, influences});
    if (real > before && (count >= likely || real > kFarAbove * least_)) break;
    before = real;
  }
}

// Whether what is coded follows the step, with the analysis that there is: it has trajectories.
bool SkinnedGofSearch::follows(double step) const {
  constexpr std::size_t kEnough = 4;
  return has_trajectories(kEnough, cached_->analysis, choice_->settings, step);
}

bool SkinnedGofSearch::needs_frames(double step, double analysis_step) const {
  return !choice_ || choice_->is_far(analysis_step) || !cached_ ||
         cached_->step != analysis_step || !follows(step);
}

void SkinnedGofSearch::analyse_for(double step) {
  if (cached_ && cached_->step == step) return;
  cached_.reset();  // before there is another
  cached_ = Cached{step, analyse(*choice_, step)};
}

void SkinnedGofSearch::analyse(double analysis_step) {
  if (!choice_ || choice_->is_far(analysis_step)) choose(analysis_step);
  analyse_for(analysis_step);
}

std::optional<double> SkinnedGofSearch::expected_error(double step) const {
  if (!cached_ || cached_->analysis.gof.bones.size() > 1) return std::nullopt;
  return expected_squared_error(cached_->analysis, step);
}

EncodedGof SkinnedGofSearch::encode(double step, double analysis_step) {
  analyse(analysis_step);
  if (!follows(step)) analyse_for(step);
  return encoded_gof(context_, code(cached_->analysis, choice_->settings, step));
}

}  // namespace rlpc
