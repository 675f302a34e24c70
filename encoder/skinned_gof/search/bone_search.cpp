#include "encoder/skinned_gof/search/bone_search.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "encoder/gof/component_cost.h"
#include "encoder/parallel/for_each.h"

namespace rlpc {
namespace {

// tuned (off: 1): Bones that a vertex may follow while bones are looked for. With more, bones
// overlap, and neither their motion nor the weights are smooth.
constexpr std::uint32_t kSearchInfluences = 2;

// tuned: Numbers of bones that are compared. Costs change little between neighbours of this
// list, and every number takes time.
constexpr std::array<std::uint32_t, 4> kFewBones{10, 20, 28, 36};
// fixed: those of kFewBones, so that slow finds what medium finds, and numbers around them.
constexpr std::array<std::uint32_t, 9> kManyBones{5, 10, 15, 20, 24, 28, 36, 48, 64};

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

BoneSearch::BoneSearch(const SkinnedContext& context, const GofFrames& frames)
    : context_(context),
      frames_(frames),
      settings_(usual_settings(context.settings)),
      max_influences_(context.settings.main.influences == 0 ? std::uint32_t{kMaxExtraBones}
                                                            : context.settings.main.influences),
      search_influences_(std::min(kSearchInfluences, max_influences_)) {}

BoneSearch::Growth BoneSearch::start(std::uint32_t influences) const {
  Growth growth{influences, std::make_unique<BoneFit>(
                                frames_, context_.triangles,
                                BoneFitOptions{.max_influences = influences})};
  growth.bones.push_back({1, growth.fit->state()});
  return growth;
}

// Fits bones of each number, ascending.
void BoneSearch::grow(std::span<const std::uint32_t> counts) {
  if (growths_.empty()) {
    for (std::uint32_t i = 1; i <= search_influences_; ++i) growths_.push_back(start(i));
  }
  for_each(growths_.size(), [&](std::size_t i) {
    Growth& growth = growths_[i];
    if (growth.bones.size() > 1) return;
    for (const std::uint32_t count : counts) {
      if (!growth.fit->grow(count)) break;
      growth.fit->settle();
      growth.bones.push_back({count, growth.fit->state()});
    }
  });
}

Rig BoneSearch::rig(Growth& growth, const BoneSolver& state, double step) const {
  return growth.fit->rig(state, growth.influences == 1 ? 1 : max_influences_, step);
}

SkinnedTrial BoneSearch::run(const SkinnedTrials& trials, Rig rig,
                             const BoneCounts& counts) const {
  return trials.run({std::move(rig), counts, settings_});
}

Rig BoneSearch::guess_one_bone(double step) {
  if (growths_.empty()) grow({});
  Growth& any = growths_.front();
  const BoneSolver& one = any.bones.front().state;
  const bool rotates =
      any.fit->expected_cost(one, step) < any.fit->expected_translation_cost(step);
  return rotates ? any.fit->rig(one, 1, step) : translation_rig(frames_);
}

SkinnedTrial BoneSearch::try_one_bone(const SkinnedTrials& trials) {
  if (context_.settings.preset != Preset::kSlow) {
    return run(trials, guess_one_bone(trials.step()), {});
  }
  Growth& any = growths_.front();
  SkinnedTrial best = run(trials, translation_rig(frames_), {});
  return std::move(*cheaper(
      std::move(best),
      run(trials, any.fit->rig(any.bones.front().state, 1, trials.step()), {})));
}

SkinnedTrial BoneSearch::try_requested(const SkinnedTrials& trials) {
  BestTrial best;
  for (std::uint32_t influences = 1; influences <= search_influences_; ++influences) {
    Growth growth = start(influences);
    growth.fit->grow(context_.settings.main.bones);
    growth.fit->settle();
    best = cheaper(std::move(best),
                   run(trials, rig(growth, growth.fit->state(), trials.step()), {}));
  }
  return std::move(*best);
}

// Bones that may be worth their bits, the most likely first: if they are expected to cost less
// than a single bone, and not more than estimates are wrong by above the least.
std::vector<BoneSearch::Candidate> BoneSearch::candidates(double step) {
  // tuned: Candidates are encoded as drafts, at most this many.
  constexpr std::size_t kDrafts = 3;
  std::vector<Candidate> list;
  for (std::size_t g = 0; g < growths_.size(); ++g) {
    for (std::size_t i = 1; i < growths_[g].bones.size(); ++i) list.push_back({g, i, 0.0});
  }
  for_each(list.size(), [&](std::size_t k) {
    const Growth& growth = growths_[list[k].growth];
    list[k].expected = growth.fit->expected_cost(growth.bones[list[k].bones].state, step);
  });
  std::stable_sort(list.begin(), list.end(), [](const Candidate& a, const Candidate& b) {
    return a.expected < b.expected;
  });
  if (context_.settings.preset == Preset::kSlow) return list;
  const double translation = growths_.front().fit->expected_translation_cost(step);
  const auto is_unlikely = [&](const Candidate& c) {
    return c.expected >= std::min((1.0 - kTryMargin) * translation,
                                  (1.0 + kTryMargin) * list.front().expected);
  };
  list.erase(std::find_if(list.begin(), list.end(), is_unlikely), list.end());
  if (list.size() > kDrafts) list.erase(list.begin() + kDrafts, list.end());
  return list;
}

// Exchanges more of the bones of a candidate; none if they were before.
BestTrial BoneSearch::polish(const SkinnedTrials& trials, const Candidate& candidate) {
  Growth& growth = growths_[candidate.growth];
  Growth::Bones& bones = growth.bones[candidate.bones];
  if (bones.polished) return std::nullopt;
  growth.fit->return_to(bones.state);
  for (int i = 0; i < 2; ++i) growth.fit->settle();
  SkinnedTrial trial = run(trials, rig(growth, growth.fit->state(), trials.step()),
                           {bones.count, growth.influences});
  bones.state.take(growth.fit->state());
  bones.polished = true;
  return trial;
}

// The numbers of bones that the settings leave.
void BoneSearch::grow() {
  if (context_.settings.main.bones > 0) return grow({});
  const bool all = context_.settings.preset == Preset::kSlow;
  grow(all ? std::span<const std::uint32_t>(kManyBones) : kFewBones);
}

SkinnedTrial BoneSearch::likeliest(const SkinnedTrials& trials) {
  if (context_.settings.main.bones > 0) return try_requested(trials);
  grow();
  const std::vector<Candidate> list = candidates(trials.step());
  return list.empty() ? run(trials, guess_one_bone(trials.step()), {})
                      : run_candidate(trials, list.front());
}

double BoneSearch::squared_spread() const { return growths_.front().fit->squared_spread(); }

SkinnedTrial BoneSearch::run_candidate(const SkinnedTrials& trials, const Candidate& candidate) {
  Growth& growth = growths_[candidate.growth];
  const Growth::Bones& bones = growth.bones[candidate.bones];
  return run(trials, rig(growth, bones.state, trials.step()),
             {bones.count, growth.influences});
}

SkinnedTrial BoneSearch::search(const SkinnedTrials& trials) {
  if (context_.settings.main.bones > 0) return try_requested(trials);
  grow();
  const std::vector<Candidate> list = candidates(trials.step());
  std::vector<BestTrial> drafts(list.size() + 1);
  for_each(drafts.size(), [&](std::size_t i) {
    if (i == 0) {
      drafts[0] = try_one_bone(trials);
      return;
    }
    drafts[i] = run_candidate(trials, list[i - 1]);
  });
  std::size_t best = 0;
  for (std::size_t i = 1; i < drafts.size(); ++i) {
    if (drafts[i]->cost < drafts[best]->cost) best = i;
  }
  BestTrial cheapest = std::move(drafts[best]);
  if (best > 0) {
    BestTrial polished = polish(trials, list[best - 1]);
    if (polished) cheapest = cheaper(std::move(cheapest), std::move(*polished));
  }
  return std::move(*cheapest);
}

}  // namespace rlpc
