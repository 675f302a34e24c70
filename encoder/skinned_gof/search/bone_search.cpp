#include "encoder/skinned_gof/search/bone_search.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <optional>
#include <utility>

#include "encoder/gof/component_cost.h"
#include "encoder/parallel/for_each.h"

namespace rlpc {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
// tuned (off: 1): Bones that a vertex may follow while bones are looked for. With more, bones
// overlap, and neither their motion nor the weights are smooth.
constexpr std::uint32_t kSearchInfluences = 2;

// tuned: Numbers of bones that are compared. Costs change little between neighbours of this
// list, and every number takes time.
constexpr std::array<std::uint32_t, 4> kFewBones{10, 20, 28, 36};
// fixed: those of kFewBones, so that slow finds what medium finds, and numbers around them.
constexpr std::array<std::uint32_t, 9> kManyBones{5, 10, 15, 20, 24, 28, 36, 48, 64};

// The first of the cheapest; the first of all exists.
SkinnedTrial cheapest(std::vector<BestTrial> trials) {
  BestTrial best;
  for (BestTrial& trial : trials) {
    if (trial) best = cheaper(std::move(best), std::move(*trial));
  }
  return std::move(*best);
}

// A single bone that only translates, with the centre of the vertices.
Rig translation_rig(const GofFrames& frames) {
  Rig rig;
  const double n = frames.num_vertices;
  rig.bones.resize(1);
  rig.bones[0].rotates = false;
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

BoneSearch::BoneSearch(const SkinnedContext& context, const GofFrames& frames,
                       const SkinnedTrials& trials)
    : context_(context),
      frames_(frames),
      trials_(trials),
      settings_(usual_settings(context.settings)),
      max_influences_(context.settings.main.influences == 0 ? std::uint32_t{kMaxExtraBones}
                                                            : context.settings.main.influences),
      search_influences_(std::min(kSearchInfluences, max_influences_)) {}

BoneFit BoneSearch::fit(std::size_t influences) const {
  return {frames_, context_.triangles, {.max_influences = influences, .step = trials_.step()}};
}

// A fit to a small sample, for estimates.
BoneFit BoneSearch::quick_fit(std::size_t influences) const {
  return {frames_,
          context_.triangles,
          {.max_influences = influences,
           .step = trials_.step(),
           .sample_frames = kSampleFrames / kQuickPart,
           .sample_vertices = kSampleVertices / kQuickPart}};
}

bool BoneSearch::grow(BoneFit& fit, std::uint32_t count) const {
  if (!fit.grow(count)) return false;
  fit.settle();
  return true;
}

SkinnedTrial BoneSearch::run(Rig rig, const BoneCounts& counts) const {
  return trials_.run({std::move(rig), counts, settings_});
}

Rig BoneSearch::guess_one_bone() const {
  const BoneFit one = quick_fit(1);
  const bool rotates = one.expected_cost() < one.expected_translation_cost();
  return rotates ? one.rig(1) : translation_rig(frames_);
}

SkinnedTrial BoneSearch::try_one_bone() const {
  if (context_.settings.preset != Preset::kSlow) return run(guess_one_bone(), {});
  SkinnedTrial best = run(translation_rig(frames_), {});
  return std::move(*cheaper(std::move(best), run(quick_fit(1).rig(1), {})));
}

BestTrial BoneSearch::try_requested() const {
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
    if (!quick.grow(count)) break;
    const double expected = quick.expected_cost();
    best.costs.push_back(expected);
    if (expected < best.cost) {
      best.cost = expected;
      best.count = count;
    }
  }
  return best;
}

// Bones are worth a trial if they are expected to save more than estimates are wrong by. What
// does not with two influences does so less with one.
BoneSearch::Estimates BoneSearch::estimates() const {
  Estimates result;
  result.of_influences.resize(search_influences_);
  for (std::uint32_t influences = search_influences_; influences > 0; --influences) {
    Estimate of = estimate(influences);
    if (of.cost >=
        std::min((1.0 - kTryMargin) * of.translation, (1.0 + kTryMargin) * result.least)) {
      break;
    }
    result.least = std::min(result.least, of.cost);
    result.of_influences[influences - 1] = std::move(of);
  }
  return result;
}

SkinnedTrial BoneSearch::search() const {
  if (context_.settings.main.bones > 0) return std::move(*try_requested());
  return context_.settings.preset == Preset::kSlow ? search_all() : search_likely();
}

// All numbers of bones.
SkinnedTrial BoneSearch::search_all() const {
  std::vector<BestTrial> trials(1 + search_influences_);
  for_each(trials.size(), [&](std::size_t i) {
    const auto influences = static_cast<std::uint32_t>(i);
    if (influences == 0) {
      trials[0] = try_one_bone();
      return;
    }
    BoneFit full = fit(influences);
    if (!grow(full, kManyBones.front())) return;
    trials[i] = try_counts(full, influences, kManyBones, kManyBones.back());
  });
  // Where bones are not worth adding, more influences are not tried.
  trials.erase(
      std::find_if(trials.begin(), trials.end(), [](const BestTrial& trial) { return !trial; }),
      trials.end());
  return cheapest(std::move(trials));
}

// The numbers of bones that are expected to cost least.
SkinnedTrial BoneSearch::search_likely() const {
  std::vector<BestTrial> trials(1 + search_influences_);
  Estimates expected;
  for_each(2, [&](std::size_t i) {
    if (i == 0) {
      expected = estimates();
    } else {
      trials[0] = try_one_bone();
    }
  });
  for_each(search_influences_, [&](std::size_t i) {
    const Estimate& estimated = expected.of_influences[i];
    if (estimated.count == 0 || estimated.cost > (1.0 + kTryMargin) * expected.least) return;
    trials[i + 1] = try_estimated(static_cast<std::uint32_t>(i + 1), estimated);
  });
  return cheapest(std::move(trials));
}

// About as many bones as are likely the best, unless the sample was too small to tell.
BestTrial BoneSearch::try_estimated(std::uint32_t influences, const Estimate& estimate) const {
  BoneFit full = fit(influences);
  const double without = full.expected_translation_cost();
  std::size_t first = 0;
  do {
    if (!grow(full, kFewBones[first])) return std::nullopt;
    const double correction = full.expected_cost() / estimate.costs[first];
    if (correction * estimate.cost >= without) return std::nullopt;
  } while (2 * kFewBones[first] < estimate.count && ++first < estimate.costs.size());
  return try_counts(full, influences, std::span(kFewBones).subspan(first), estimate.count);
}

// Encodes with each of `counts` bones, ascending; `full` already has the first number. Stops
// once the cost rises at or beyond the number that is likely the best.
BestTrial BoneSearch::try_counts(BoneFit& full, std::uint32_t influences,
                                 std::span<const std::uint32_t> counts,
                                 std::uint32_t likely) const {
  BestTrial best;
  double expected = kNone;
  double before = kNone;
  bool has_grown = true;
  for (std::size_t i = 0; i < counts.size() && has_grown; ++i) {
    const double now = full.expected_cost();
    expected = std::min(expected, now);
    std::optional<Rig> rig;
    if (now <= (1.0 + kTryMargin) * expected) {
      rig = full.rig(influences == 1 ? 1 : max_influences_);
    }
    BestTrial trial;
    std::atomic<bool> ends = i + 1 == counts.size();
    for_each(2, [&](std::size_t pass) {
      if (pass == 0 && rig) {
        trial = run(std::move(*rig), {counts[i], influences});
        if (trial->cost > before && counts[i] >= likely) ends = true;
      } else if (pass == 1 && !ends) {  // if threads grow ahead, perhaps for nothing
        has_grown = grow(full, counts[i + 1]);
      }
    });
    if (trial) {
      before = trial->cost;
      best = cheaper(std::move(best), std::move(*trial));
    }
    if (ends) break;
  }
  return best;
}

}  // namespace rlpc
