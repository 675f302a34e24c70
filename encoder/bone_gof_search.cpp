#include "encoder/bone_gof_search.h"

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/bone_recon.h"
#include "encoder/bone_fit.h"
#include "encoder/write_bone_gof.h"

namespace rlpc {
namespace {

// Bones are compared by cost when they leave less error than this many steps,
constexpr double kNearError = 3.0;
// and looked for at all when a few leave less than this.
constexpr double kPromisingError = 1.6;
constexpr std::uint32_t kMinVerticesOfBone = 8;
constexpr std::uint32_t kUsualBones = 20;
constexpr std::uint32_t kUsualInfluences = 3;
// Error that one bone may leave of that of one which does not turn, to be chosen unseen.
constexpr double kRigidPart = 0.4;

// Numbers of bones worth comparing.
std::span<const std::uint32_t> counts(Preset preset) {
  static constexpr std::array<std::uint32_t, 4> kFew{5, 10, 20, 36};
  static constexpr std::array<std::uint32_t, 10> kMany{4, 6, 9, 13, 16, 20, 25, 30, 36, 48};
  if (preset == Preset::kSlow) return kMany;
  return kFew;
}

BoneFitOptions bone_options(std::size_t influences, double step) {
  return {.max_influences = influences, .step = step};
}

EncodedGof encoded_gof(const BoneContext& context, const BoneGof& gof) {
  EncodedGof encoded;
  BoneGofPayloads payloads = write_bone_gof(gof, context.mesh, context.position_bits);
  encoded.units.push_back({UnitType::kGof, std::move(payloads.gof)});
  for (auto& slice : payloads.slices) {
    encoded.units.push_back({UnitType::kSlice, std::move(slice)});
  }
  const auto recon = std::make_shared<BoneRecon>(context.mesh, gof, context.position_bits);
  encoded.frame = [recon](std::uint32_t f, std::span<std::int32_t> positions) {
    recon->frame(f, positions);
  };
  encoded.clusters = static_cast<std::uint32_t>(gof.bones.size());
  encoded.components = static_cast<std::uint32_t>(gof.trajectories.size());
  encoded.num_factors = 6 * std::uint64_t{gof.bones.size()} * gof.num_frames +
                        3 * std::uint64_t{context.mesh.num_vertices()} +
                        gof.trajectories.size() *
                            (context.mesh.num_vertices() + 3 * std::uint64_t{gof.num_frames});
  return encoded;
}

// One bone that does not turn: it follows the centre of the vertices.
Rig sliding_rig(const GofFrames& frames) {
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

BoneGofSearch::BoneGofSearch(const BoneContext& context, const GofFrames& frames,
                             std::uint32_t first_frame, const EncoderSettings& settings,
                             std::optional<RigChoice>& choice)
    : context_(context),
      frames_(frames),
      first_frame_(first_frame),
      preset_(settings.preset),
      bones_(settings.main.bones),
      max_influences_(settings.main.influences == 0 ? kUsualInfluences
                                                    : settings.main.influences),
      choice_(choice) {
  const MainTools& tools = settings.main;
  settings_.prediction = tools.prediction;
  if (!tools.geometry_weights) settings_.damping_log2 = 0;
  if (!tools.outer_ring) settings_.outer_weight = 0;
  if (!tools.outer_ring) settings_.outer_scale = 0;
  settings_.layer_steps = tools.layer_steps;
  settings_.temporal_weights = tools.temporal_weights;
  settings_.cobra_steps = tools.cobra_steps;
  settings_.component_groups = tools.component_groups;
  settings_.layer_groups = tools.layer_groups;
  if (settings.components > 0) settings_.max_trajectories = settings.components;
}

BoneAnalysis BoneGofSearch::analyse(const Rig& rig, double step) const {
  return analyse_bones(context_.mesh, context_.position_bits, frames_, first_frame_, rig,
                       settings_, step);
}

double BoneGofSearch::cost(const Rig& rig, double step) const {
  const BoneAnalysis analysis = analyse(rig, step);
  const EncodedGof encoded =
      encoded_gof(context_, code_bone_gof(context_.mesh, analysis, settings_, step));
  double bits = 0.0;
  for (const auto& unit : encoded.units) bits += 8.0 * static_cast<double>(unit.payload.size());
  return squared_error(frames_, encoded.frame) + kErrorPerBit * step * step * bits;
}

// A small sample shows whether bones are worth a search.
BoneFit BoneGofSearch::quick_fit(double step) const {
  BoneFitOptions options = bone_options(max_influences_, step);
  options.sample_frames = 24;
  options.sample_vertices = 700;
  return {frames_, context_.triangles, options};
}

bool BoneGofSearch::bones_promise(double step) const {
  constexpr std::size_t kBones = 20;
  BoneFit fit = quick_fit(step);
  fit.grow(kBones);
  return fit.rms_error() < kPromisingError * step;
}

// One bone that turns, if that makes much of a difference, else one that does not.
Rig BoneGofSearch::quick_choice(double step) const {
  const BoneFit fit = quick_fit(step);
  return fit.rms_error() < kRigidPart * fit.sliding_error() ? fit.rig(1) : sliding_rig(frames_);
}

Rig BoneGofSearch::choose(double step) const {
  if (preset_ == Preset::kFast && bones_ == 0) return quick_choice(step);
  // Where vertices follow one bone while bones are looked for, these are more likely to be
  // parts that move rigidly.
  BoneFit hard(frames_, context_.triangles, bone_options(1, step));
  if (bones_ > 0) {
    hard.grow(bones_);
    return hard.rig(max_influences_);
  }
  Rig best = sliding_rig(frames_);
  double least = cost(best, step);
  const auto consider = [&](Rig rig) {
    const double now = cost(rig, step);
    if (now >= least) return false;
    least = now;
    best = std::move(rig);
    return true;
  };
  consider(hard.rig(1));
  if (preset_ == Preset::kMedium && !bones_promise(step)) return best;
  std::uint32_t best_count = kUsualBones;
  for (const std::uint32_t count : counts(preset_)) {
    if (count * kMinVerticesOfBone > frames_.num_vertices || !hard.grow(count)) break;
    if (hard.rms_error() > kNearError * step) continue;
    if (consider(hard.rig(1))) best_count = count;
    if (max_influences_ > 1 && consider(hard.rig(max_influences_))) best_count = count;
  }
  if (max_influences_ == 1) return best;
  BoneFit soft(frames_, context_.triangles, bone_options(max_influences_, step));
  for (const std::uint32_t count : counts(preset_)) {
    if (preset_ != Preset::kSlow && count != best_count) continue;
    if (count * kMinVerticesOfBone > frames_.num_vertices || !soft.grow(count)) break;
    if (soft.rms_error() < kNearError * step) consider(soft.rig(max_influences_));
  }
  return best;
}

EncodedGof BoneGofSearch::encode(double step, double analysis_step) {
  if (!choice_ || choice_->is_far(analysis_step)) {
    const int times = choice_ ? choice_->times : 0;
    choice_ = RigChoice{choose(analysis_step), analysis_step, times + 1};
    cached_.reset();
  }
  const auto code_at = [&](double wanted) {
    if (!cached_ || cached_->step != wanted) {
      cached_ = Cached{wanted, analyse(choice_->rig, wanted)};
    }
    return code_bone_gof(context_.mesh, cached_->analysis, settings_, step);
  };
  BoneGof gof = code_at(analysis_step);
  // Without trajectories, nothing but the analysis depends on the step.
  if (gof.trajectories.empty()) gof = code_at(step);
  return encoded_gof(context_, gof);
}

}  // namespace rlpc
