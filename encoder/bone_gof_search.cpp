#include "encoder/bone_gof_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/bone_recon.h"
#include "encoder/bone_fit.h"
#include "encoder/write_bone_gof.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kMinVerticesOfBone = 8;
constexpr std::uint32_t kUsualInfluences = 4;
// Bones are looked for with vertices that follow one, and with vertices that follow two: with
// more, bones overlap, and neither they nor weights are smooth.
constexpr std::uint32_t kSearchInfluences = 2;
// Error that one bone may leave of that of one which does not turn, to be chosen unseen.
constexpr double kRigidPart = 0.4;
// Expected costs, relative to that without bones, at which these are looked for; and relative
// to the least, at which they are tried.
constexpr double kPromising = 0.85;
constexpr double kNearLeast = 1.06;
// So many bones tell whether more are worth looking at: not above this expected cost.
constexpr std::uint32_t kEnoughBones = 20;
constexpr double kHopeless = 0.92;

// Numbers of bones worth comparing.
std::span<const std::uint32_t> counts(Preset preset) {
  static constexpr std::array<std::uint32_t, 4> kFew{10, 20, 28, 36};
  static constexpr std::array<std::uint32_t, 9> kMany{5, 10, 15, 20, 24, 28, 36, 48, 64};
  if (preset == Preset::kSlow) return kMany;
  return kFew;
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

double BoneGofSearch::cost(const BoneAnalysis& analysis, double step) const {
  const EncodedGof encoded =
      encoded_gof(context_, code_bone_gof(context_.mesh, analysis, settings_, step));
  double bits = 0.0;
  for (const auto& unit : encoded.units) bits += 8.0 * static_cast<double>(unit.payload.size());
  return squared_error(frames_, encoded.frame) + kErrorPerBit * step * step * bits;
}

BoneFit BoneGofSearch::fit(std::size_t influences, double step) const {
  return {frames_, context_.triangles, {.max_influences = influences, .step = step}};
}

// From a small sample.
BoneFit BoneGofSearch::quick_fit(std::size_t influences, double step) const {
  return {frames_,
          context_.triangles,
          {.max_influences = influences,
           .step = step,
           .sample_frames = 24,
           .sample_vertices = 700,
           .exchanges = 2}};
}

// One bone that turns, if that makes much of a difference, else one that does not.
Rig BoneGofSearch::quick_choice(double step) const {
  const BoneFit quick = quick_fit(1, step);
  return quick.rms_error() < kRigidPart * quick.sliding_error() ? quick.rig(1)
                                                                : sliding_rig(frames_);
}

// The numbers of bones that a small sample promises most of, with vertices that follow so many.
BoneGofSearch::Promise BoneGofSearch::promise(std::size_t influences, double step) const {
  Promise best;
  BoneFit quick = quick_fit(influences, step);
  const double sliding = quick.expected_sliding_cost();
  for (const std::uint32_t count : counts(preset_)) {
    if (count * kMinVerticesOfBone > frames_.num_vertices || !quick.grow(count)) break;
    const double part = quick.expected_cost() / sliding;
    if (part < best.part) best = {count, part};
    if (count >= kEnoughBones && best.part > kHopeless) break;
  }
  return best;
}

// Keeps a rig if it costs less than the one before, with its analysis.
double BoneGofSearch::consider(Rig rig, double step, double& least) {
  BoneAnalysis analysis = analyse(rig, step);
  const double now = cost(analysis, step);
  if (now < least) {
    least = now;
    choice_->rig = std::move(rig);
    cached_ = Cached{step, std::move(analysis)};
  }
  return now;
}

void BoneGofSearch::choose(double step) {
  cached_.reset();
  if (preset_ == Preset::kFast && bones_ == 0) {
    choice_->rig = quick_choice(step);
    return;
  }
  double least = std::numeric_limits<double>::infinity();
  const std::uint32_t most = std::min(kSearchInfluences, max_influences_);
  const auto final_influences = [&](std::uint32_t influences) {
    return influences == 1 ? 1 : max_influences_;
  };
  if (bones_ > 0) {
    for (std::uint32_t influences = 1; influences <= most; ++influences) {
      BoneFit full = fit(influences, step);
      full.grow(bones_);
      consider(full.rig(final_influences(influences)), step, least);
    }
    return;
  }
  consider(sliding_rig(frames_), step, least);
  consider(quick_fit(1, step).rig(1), step, least);
  // What does not promise much with two influences does so less with one.
  std::array<Promise, kSearchInfluences> promises;
  double promised = kPromising;
  for (std::uint32_t influences = most; influences > 0; --influences) {
    promises[influences - 1] = promise(influences, step);
    if (promises[influences - 1].part > promised) break;
    promised = std::min(promised, promises[influences - 1].part * kNearLeast);
  }
  const bool slow = preset_ == Preset::kSlow;
  for (std::uint32_t influences = 1; influences <= most; ++influences) {
    const Promise& promise = promises[influences - 1];
    if (!slow && promise.part > promised) continue;
    BoneFit full = fit(influences, step);
    double expected = std::numeric_limits<double>::infinity();
    double before = expected;
    for (const std::uint32_t count : counts(preset_)) {
      if (!slow && count > promise.count) break;
      if (count * kMinVerticesOfBone > frames_.num_vertices || !full.grow(count)) break;
      const double now = full.expected_cost();
      expected = std::min(expected, now);
      if (now > kNearLeast * expected) continue;
      const double real = consider(full.rig(final_influences(influences)), step, least);
      if (!slow && real > before) break;
      before = real;
    }
  }
}

EncodedGof BoneGofSearch::encode(double step, double analysis_step) {
  if (!choice_ || choice_->is_far(analysis_step)) {
    const int times = choice_ ? choice_->times : 0;
    choice_ = RigChoice{{}, analysis_step, times + 1};
    choose(analysis_step);
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
