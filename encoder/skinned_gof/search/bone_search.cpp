#include "encoder/skinned_gof/search/bone_search.h"

#include <algorithm>
#include <array>
#include <utility>

namespace rlpc {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kMinVerticesOfBone = 8;  // tuned (off: 1): fewer do not make a bone
constexpr std::uint32_t kUsualInfluences = 4;    // tuned (off: 1): bones of a vertex
// With more than two, bones overlap, and neither they nor weights are smooth.
constexpr std::uint32_t kSearchInfluences = 2;  // tuned (off: 1): likewise, of a search
// Parts of the error of one bone that does not turn which one that turns leaves.
constexpr double kRigidPart = 0.5;     // tuned (off: 1): below, one bone turns
constexpr double kFlexiblePart = 1.0;  // tuned: above, one bone does not turn
// Expected costs at which bones are looked for: relative to those expected without bones, to
// the real ones without, and to the real ones once the first bones are there.
constexpr double kTryFactor = 0.72;           // tuned (off: 1e9): expected, to expected without
constexpr double kTryFactorOfReal = 0.85;     // tuned (off: 1e9): expected, to real without
constexpr double kTryFactorUnsettled = 0.93;  // tuned (off: 1e9): with the first bones
constexpr double kTryFactorSettled = 0.9;     // tuned (off: 1e9): once these have settled
constexpr double kSure = 0.3;                 // tuned (off: 0): below, one bone is not tried
// What makes the real cost without bones low, such as vertices at rest, is there with bones,
// too.
constexpr double kStrongEstimate = 0.5;  // tuned (off: 0): below, estimates beat real costs
// Thresholds are so much higher where a trial takes little time.
constexpr std::uint32_t kSmallMesh = 1000;     // tuned (off: 0): vertices
constexpr double kHopeOfSmallMesh = 1.35;      // tuned (off: 1): thresholds, of a small mesh
constexpr double kHopeOfFewValues = 1.07;      // tuned (off: 1): thresholds, of few values
constexpr std::uint64_t kFewValues = 200'000;  // tuned (off: 0): vertices times frames
// Numbers of bones to be tried, by expected costs relative to the least.
constexpr double kNearLeast = 0.06;   // tuned (off: 1e9): of influences that are tried
constexpr double kWorthATrial = 0.2;  // tuned (off: 1e9): of a number that is tried
constexpr double kFarAbove = 0.1;     // tuned (off: 1e9): real costs that will not fall again
// So many bones tell whether more are worth looking at.
constexpr std::uint32_t kEnoughBones = 20;  // tuned (off: 1000000): bones in a sample
constexpr double kHopeless = 0.92;          // tuned (off: 1e9): expected of these, to stop

// Numbers of bones worth comparing.
constexpr std::array<std::uint32_t, 4> kFewBones{10, 20, 28, 36};  // tuned: bones
constexpr std::array<std::uint32_t, 9> kManyBones{5,  10, 15, 20, 24,
                                                  28, 36, 48, 64};  // tuned: slow

// Of a small sample, for estimates.
constexpr std::uint32_t kQuickFrames = 24;     // tuned: frames
constexpr std::uint32_t kQuickVertices = 700;  // tuned: vertices
constexpr int kQuickExchanges = 2;             // tuned (off: 0): of bones

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

// The part of a translation's error that one turning bone leaves.
double part_left(const BoneFit& one) {
  const double translation = one.translation_error();
  return translation > 0.0 ? one.rms_error() / translation : 1.0;  // nothing moves
}

}  // namespace

BoneSearch::BoneSearch(const SkinnedContext& context, const GofFrames& frames,
                       const SkinnedTrials& trials)
    : context_(context),
      frames_(frames),
      trials_(trials),
      settings_(usual_settings(context.settings)),
      max_influences_(context.settings.main.influences == 0 ? kUsualInfluences
                                                            : context.settings.main.influences),
      search_influences_(std::min(kSearchInfluences, max_influences_)),
      threshold_factor_(threshold_factor_of(frames)) {}

BoneFit BoneSearch::fit(std::size_t influences) const {
  return {frames_, context_.triangles, {.max_influences = influences, .step = trials_.step()}};
}

// From a small sample.
BoneFit BoneSearch::quick_fit(std::size_t influences) const {
  return {frames_,
          context_.triangles,
          {.max_influences = influences,
           .step = trials_.step(),
           .sample_frames = kQuickFrames,
           .sample_vertices = kQuickVertices,
           .exchanges = kQuickExchanges}};
}

bool BoneSearch::can_have(std::uint32_t count) const {
  return count * kMinVerticesOfBone <= frames_.num_vertices;
}

bool BoneSearch::grow(BoneFit& fit, std::uint32_t count) const {
  if (!can_have(count) || !fit.grow(count)) return false;
  fit.settle();
  return true;
}

SkinnedTrial BoneSearch::run(Rig rig, const BoneCounts& counts) const {
  return trials_.run({std::move(rig), counts, settings_});
}

Rig BoneSearch::guess_one_bone() const {
  const BoneFit one = quick_fit(1);
  return part_left(one) < kRigidPart ? one.rig(1) : translation_rig(frames_);
}

SkinnedTrial BoneSearch::try_one_bone() const {
  const BoneFit one = quick_fit(1);
  const double part = part_left(one);
  const bool slow = context_.settings.preset == Preset::kSlow;
  BestTrial best;
  if (slow || part >= kRigidPart) best = run(translation_rig(frames_), {});
  if (slow || part < kFlexiblePart) best = cheaper(std::move(best), run(one.rig(1), {}));
  return std::move(*best);
}

BestTrial BoneSearch::try_asked() const {
  BestTrial best;
  for (std::uint32_t influences = 1; influences <= search_influences_; ++influences) {
    BoneFit full = fit(influences);
    full.grow(context_.settings.main.bones);
    full.settle();
    best = cheaper(std::move(best), run(full.rig(influences == 1 ? 1 : max_influences_), {}));
  }
  return best;
}

BoneSearch::Estimate BoneSearch::estimate(std::size_t influences) const {
  Estimate best;
  BoneFit quick = quick_fit(influences);
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

// What does not promise much with two influences does so less with one.
BoneSearch::Estimates BoneSearch::estimates() const {
  Estimates result;
  result.of_influences.resize(search_influences_);
  for (std::uint32_t influences = search_influences_; influences > 0; --influences) {
    Estimate of = estimate(influences);
    result.translation = of.translation;
    if (of.cost > std::min(threshold_factor_ * kTryFactor * of.translation,
                           (1.0 + kNearLeast) * result.least)) {
      break;
    }
    result.least = std::min(result.least, of.cost);
    result.of_influences[influences - 1] = std::move(of);
  }
  return result;
}

SkinnedTrial BoneSearch::search() const {
  if (context_.settings.main.bones > 0) return std::move(*try_asked());
  const bool slow = context_.settings.preset == Preset::kSlow;
  const Estimates expected = estimates();
  BestTrial best;
  double without = expected.translation;
  if (expected.least > kSure * expected.translation || slow) {
    best = try_one_bone();
    without = best->cost;
  }
  for (std::uint32_t influences = 1; influences <= search_influences_; ++influences) {
    const Estimate& of = expected.of_influences[influences - 1];
    const bool strong = of.cost < kStrongEstimate * of.translation;
    const double against = strong ? std::max(without, of.translation) : without;
    if (of.cost <= std::min((1.0 + kNearLeast) * expected.least,
                            threshold_factor_ * kTryFactorOfReal * against)) {
      best = try_estimated(std::move(best), influences, of, against);
    }
    if (slow) {
      BoneFit full = fit(influences);
      if (!grow(full, kManyBones.front())) break;
      best = try_counts(std::move(best), full, influences, kManyBones, kManyBones.back());
    }
  }
  return best ? std::move(*best) : try_one_bone();
}

SkinnedTrial BoneSearch::search_near(const BoneCounts& counts, bool finer) const {
  const auto at = std::find(kFewBones.begin(), kFewBones.end(), counts.bones);
  const auto first = finer || at == kFewBones.begin() ? at : at - 1;
  const auto end = finer ? std::min(at + 2, kFewBones.end()) : at + 1;
  BestTrial best;
  if (!finer && first == kFewBones.begin()) best = try_one_bone();
  BoneFit full = fit(counts.influences);
  if (grow(full, *first)) {
    best = try_counts(std::move(best), full, counts.influences, std::span(first, end),
                      counts.bones);
  }
  return best ? std::move(*best) : try_one_bone();
}

// About as many bones as are likely the best, unless the sample was too small to tell.
BestTrial BoneSearch::try_estimated(BestTrial best, std::uint32_t influences,
                                    const Estimate& estimate, double without) const {
  BoneFit full = fit(influences);
  std::size_t first = 0;
  const auto is_below = [&](double part) {
    const double correction = full.expected_cost() / estimate.costs[first];
    return correction * estimate.cost < threshold_factor_ * part * without;
  };
  do {
    if (!can_have(kFewBones[first]) || !full.grow(kFewBones[first])) return best;
    if (!is_below(kTryFactorUnsettled)) return best;
    full.settle();
    if (!is_below(kTryFactorSettled)) return best;
  } while (2 * kFewBones[first] < estimate.count && ++first < estimate.costs.size());
  return try_counts(std::move(best), full, influences, std::span(kFewBones).subspan(first),
                    estimate.count);
}

// Growing numbers of bones, of which the first are there, until the cost rises beyond the
// number that is likely the best.
BestTrial BoneSearch::try_counts(BestTrial best, BoneFit& full, std::uint32_t influences,
                                 std::span<const std::uint32_t> counts,
                                 std::uint32_t likely) const {
  double expected = kNone;
  double before = kNone;
  for (const std::uint32_t count : counts) {
    if (count != counts.front() && !grow(full, count)) break;
    const double now = full.expected_cost();
    expected = std::min(expected, now);
    if (now > threshold_factor_ * (1.0 + kWorthATrial) * expected) continue;
    SkinnedTrial trial =
        run(full.rig(influences == 1 ? 1 : max_influences_), {count, influences});
    const double real = trial.cost;
    best = cheaper(std::move(best), std::move(trial));
    if (real > before && (count >= likely || real > (1.0 + kFarAbove) * best->cost)) break;
    before = real;
  }
  return best;
}

}  // namespace rlpc
