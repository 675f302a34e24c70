#include "encoder/skinned_gof/search/bone_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>

#include "encoder/gof/component_cost.h"
#include "encoder/gof/count_at.h"
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
constexpr std::array<std::uint32_t, 8> kManyBones = [] {  // fixed: slow tries all of a series
  std::array<std::uint32_t, 8> counts{};
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = count_at(i + 4);  // 6 to 64
  return counts;
}();

// tuned (off: 1e9): A single bone is encoded as well if its expected cost is below this
// multiple of that of several bones.
constexpr double kOneBone = 1.5;

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

// A fit to a sample; part: the sample has this fraction of the frames and vertices of the full
// one.
BoneFit BoneSearch::fit(std::size_t influences, std::uint32_t part) const {
  const bool is_small = frames_.num_vertices <= kSampleVertices / 2;
  return {frames_,
          context_.triangles,
          {.max_influences = influences,
           .step = trials_.step(),
           .sample_frames = kSampleFrames / part * (is_small ? 2 : 1),
           .sample_vertices = (part > 1 ? 750 : kSampleVertices)}};
}

SkinnedTrial BoneSearch::run(Rig rig, const BoneCounts& counts) const {
  return trials_.run({std::move(rig), counts, settings_});
}

SkinnedTrial BoneSearch::run(const Candidate& candidate) const {
  const BoneCounts& counts = candidate.counts;
  return run(candidate.fit->rig(counts.influences == 1 ? 1 : max_influences_), counts);
}

Rig BoneSearch::guess_one_bone() const {
  const BoneFit one = fit(1, kQuickPart);
  const bool rotates = one.expected_cost() < one.expected_translation_cost();
  return rotates ? one.rig(1) : translation_rig(frames_);
}

std::vector<SkinnedTrial> BoneSearch::try_one_bone() const {
  std::vector<SkinnedTrial> trials;
  if (context_.settings.preset == Preset::kSlow) {
    trials.push_back(run(translation_rig(frames_), {}));
    trials.push_back(run(fit(1, kQuickPart).rig(1), {}));
  } else {
    trials.push_back(run(guess_one_bone(), {}));
  }
  return trials;
}

BestTrial BoneSearch::try_requested() const {
  BestTrial best;
  for (std::uint32_t influences = 1; influences <= search_influences_; ++influences) {
    BoneFit full = fit(influences, 1);
    full.grow(context_.settings.main.bones);
    full.settle();
    best = cheaper(std::move(best), run(full.rig(influences == 1 ? 1 : max_influences_), {}));
  }
  return best;
}

// One fit that grows to each of `counts`, ascending and of kFewBones, as far as bones are worth
// adding. It stops at all numbers on the way, so that the bones do not depend on `counts`.
BoneSearch::Candidates BoneSearch::grown(std::uint32_t influences,
                                         std::span<const std::uint32_t> counts,
                                         std::uint32_t part) const {
  BoneFit growing = fit(influences, part);
  Candidates result;
  result.of_one = std::min(growing.expected_cost(), growing.expected_translation_cost());
  for (const std::uint32_t count : kFewBones) {
    if (count > counts.back() || !growing.grow(count)) break;
    if (!std::binary_search(counts.begin(), counts.end(), count)) continue;
    result.list.push_back({std::make_unique<BoneFit>(growing), {count, influences}, 0.0});
  }
  return result;
}

// Fits with given numbers of bones to a sample.
BoneSearch::Candidates BoneSearch::candidates_from(std::span<const BoneCounts> counts,
                                                   std::uint32_t part, bool settles) const {
  std::vector<Candidates> by_influences(search_influences_);
  for_each(search_influences_, [&](std::size_t i) {
    const auto influences = static_cast<std::uint32_t>(i + 1);
    std::vector<std::uint32_t> ascending;
    for (const BoneCounts& c : counts) {
      if (c.influences == influences) ascending.push_back(c.bones);
    }
    std::sort(ascending.begin(), ascending.end());
    if (!ascending.empty()) by_influences[i] = grown(influences, ascending, part);
  });
  Candidates result;
  for (Candidates& some : by_influences) {
    result.of_one = std::min(result.of_one, some.of_one);
    for (Candidate& c : some.list) result.list.push_back(std::move(c));
  }
  for_each(result.list.size(), [&](std::size_t i) {
    Candidate& c = result.list[i];
    if (settles) c.fit->settle();
    c.expected = c.fit->expected_cost();
  });
  std::stable_sort(
      result.list.begin(), result.list.end(),
      [](const Candidate& a, const Candidate& b) { return a.expected < b.expected; });
  return result;
}

// Each number of bones is tried on a small sample without exchanges, the best of them on a
// larger one with exchanges, and the best of these are encoded.
SkinnedTrial BoneSearch::search_by_samples() const {
  // tuned: Candidates that are fitted to the larger sample.
  constexpr std::size_t kFitted = 4;
  // tuned: Of these, candidates that are encoded, where their expected costs are close.
  constexpr std::size_t kEncoded = 2;
  std::vector<BoneCounts> counts;
  for (std::uint32_t influences = 1; influences <= search_influences_; ++influences) {
    for (const std::uint32_t count : kFewBones) counts.push_back({count, influences});
  }
  const Candidates rough = candidates_from(counts, kQuickPart, false);
  counts.clear();
  for (const Candidate& c : rough.list) {
    const bool is_worthwhile = c.expected < (1.0 - kTryMargin) * rough.of_one;
    if (is_worthwhile && counts.size() < kFitted) counts.push_back(c.counts);
  }
  Candidates fitted = candidates_from(counts, 1, true);
  std::vector<Candidate>& list = fitted.list;
  while (!list.empty() && (list.size() > kEncoded || list.back().expected >= fitted.of_one ||
                           list.back().expected > (1.0 + kTryMargin) * list.front().expected)) {
    list.pop_back();
  }
  const bool tries_one = list.empty() || fitted.of_one < kOneBone * list.front().expected;
  std::vector<BestTrial> trials(list.size() + 1);
  for_each(trials.size(), [&](std::size_t i) {
    if (i > 0) {
      trials[i] = run(list[i - 1]);
    } else if (tries_one) {
      trials[i] = run(guess_one_bone(), {});
    }
  });
  BestTrial best;
  for (BestTrial& trial : trials) {
    if (trial) best = cheaper(std::move(best), std::move(*trial));
  }
  return std::move(*best);
}

// Encodes every candidate.
SkinnedTrial BoneSearch::search_all() const {
  BestTrial best;
  for (SkinnedTrial& trial : try_one_bone()) best = cheaper(std::move(best), std::move(trial));
  for (std::uint32_t influences = 1; influences <= search_influences_; ++influences) {
    BoneFit full = fit(influences, 1);
    double before = kNone;
    for (const std::uint32_t count : kManyBones) {
      if (!full.grow(count)) break;
      full.settle();
      SkinnedTrial trial =
          run(full.rig(influences == 1 ? 1 : max_influences_), {count, influences});
      const double actual = trial.cost;
      best = cheaper(std::move(best), std::move(trial));
      if (actual > before && count >= kManyBones.back()) break;
      before = actual;
    }
  }
  return std::move(*best);
}

SkinnedTrial BoneSearch::search() const {
  if (context_.settings.main.bones > 0) return std::move(*try_requested());
  return context_.settings.preset == Preset::kSlow ? search_all() : search_by_samples();
}

}  // namespace rlpc
