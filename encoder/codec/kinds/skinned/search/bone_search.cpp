#include "encoder/codec/kinds/skinned/search/bone_search.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/fit/rig_joints.h"
#include "encoder/codec/kinds/skinned/recover/recovered_rig.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/component_cost.h"
#include "encoder/codec/spans/lagrangian.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {
namespace {

// tuned (off: 1): Bones that a vertex may follow while bones are looked for. With more, bones
// overlap, and neither their motion nor the weights are smooth.
constexpr std::uint32_t kSearchInfluences = 2;

// tuned: Numbers of bones that are compared. Costs change little between neighbours of this
// list, and every number takes time.
constexpr std::array<std::uint32_t, 4> kFewBones{10, 20, 28, 36};
// tuned: The number of bones that the fast preset fits.
constexpr std::array<std::uint32_t, 1> kUsualBones{20};
// tuned (off: 0): Rounds of exchanges with the fast preset (BoneFitOptions::kExchanges).
constexpr int kFastExchanges = 1;
// fixed: those of kFewBones, so that slow finds what medium finds, and numbers around them.
constexpr std::array<std::uint32_t, 9> kManyBones{5, 10, 15, 20, 24, 28, 36, 48, 64};

// A single bone that only translates, with the centre of the vertices.
Rig translation_rig(const SpanFrames& frames) {
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

// The fraction of the work on a span that is done after a stage, on characters of one to four
// thousand vertices; the rest is an analysis and an encoding.
constexpr double kFitted = 0.25;    // fixed: measured
constexpr double kDrafted = 0.5;    // fixed: measured
constexpr double kCompared = 0.75;  // fixed: measured

constexpr double kMinError = 1e-6;  // fixed: above zero

}  // namespace

BoneSearch::BoneSearch(const SkinnedContext& context, const SpanFrames& frames)
    : context_(context),
      frames_(frames),
      settings_(usual_settings(context.settings)),
      max_influences_(context.settings.main.influences == 0 ? std::uint32_t{kMaxExtraBones}
                                                            : context.settings.main.influences),
      search_influences_(std::min(kSearchInfluences, max_influences_)) {}

BoneSearch::Growth BoneSearch::start(std::uint32_t influences) const {
  BoneFitOptions options{.max_influences = influences};
  if (context_.settings.preset == Preset::kFast && context_.settings.main.bones == 0) {
    options.exchanges = kFastExchanges;
  }
  Growth growth{influences, std::make_unique<BoneFit>(frames_, context_.triangles, options)};
  growth.bones.push_back({1, growth.fit->state(), growth.fit->spectrum(growth.fit->state())});
  return growth;
}

void BoneSearch::start_all() {
  if (!growths_.empty()) return;
  for (std::uint32_t i = 1; i <= search_influences_; ++i) growths_.push_back(start(i));
  translation_ = growths_.front().fit->translation_spectrum();
}

double BoneSearch::translation_cost(double step) const {
  return rlpc::expected_cost(translation_, frames_.num_vertices, frames_.num_frames, step);
}

double BoneSearch::one_bone_cost(double step) const {
  return actual_to_expected_ * translation_cost(step);
}

// Bones are tried if they are expected to cost less.
double BoneSearch::worth_trying(double step) const {
  return (1.0 - kTryMargin) * one_bone_cost(step);
}

double BoneSearch::expected_cost(const Growth& growth, const Growth::Bones& bones,
                                 double step) const {
  return growth.fit->expected_cost(bones.state, bones.spectrum, step);
}

// Fits bones of each number, ascending, as long as they may be better worth their bits than a
// single bone, others with the same number, and those before.
void BoneSearch::grow_all(double step) {
  const Stage stage("bones");
  // tuned (off: 100): Numbers of bones that are fitted, in ascending order, before expected
  // costs may decide that no bones are used.
  constexpr std::size_t kTelling = 2;
  start_all();
  if (growths_.front().bones.size() > 1) return;
  const bool all = context_.settings.preset == Preset::kSlow;
  const bool fast = context_.settings.preset == Preset::kFast;
  const std::span<const std::uint32_t> counts =
      all    ? std::span<const std::uint32_t>(kManyBones)
      : fast ? std::span<const std::uint32_t>(kUsualBones)
             : kFewBones;
  std::vector<Growth*> growing;
  for (Growth& growth : growths_) growing.push_back(&growth);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> before(growing.size(), kNone);  // costs of the number before
  double last = kNone;
  for (std::size_t i = 0; i < counts.size() && !growing.empty(); ++i) {
    std::vector<double> cost(growing.size());
    // A single bone is analysed in any case: to compare bones with it, or to survey it.
    std::optional<SkinnedCandidate> one;
    if (!all && !fast && i + 1 == kTelling) {
      one = one_bone(step);
      one->settings.draft = true;
    }
    for_each(growing.size() + (one ? 1 : 0), [&](std::size_t k) {
      if (k == growing.size()) {
        one_ = analyse_candidate(context_, frames_, *one, step);
        return;
      }
      Growth& growth = *growing[k];
      cost[k] = kNone;
      if (!growth.fit->grow(counts[i])) return;
      growth.fit->settle();
      growth.bones.push_back(
          {counts[i], growth.fit->state(), growth.fit->spectrum(growth.fit->state())});
      cost[k] = expected_cost(growth, growth.bones.back(), step);
    });
    progress_(kFitted * static_cast<double>(i + 1) / static_cast<double>(counts.size()));
    const double count_cost = *std::min_element(cost.begin(), cost.end());
    const double next = count_cost - (last - count_cost);  // assumes the same gain again
    last = count_cost;
    const bool telling = !all && i + 1 >= kTelling;
    const bool promising = count_cost < worth_trying(step);
    if (telling && promising && one_ && !is_compared_) {
      is_compared_ = true;
      try_one_bone(SkinnedTrials(context_, frames_, step));  // for its cost, not the trial
    }
    std::vector<Growth*> still;
    std::vector<double> remaining_costs;
    for (std::size_t k = 0; k < growing.size(); ++k) {
      const bool ended = growing[k]->bones.back().count != counts[i];
      const bool hopeless = telling && cost[k] > (1.0 + kTryMargin) * count_cost;
      const bool rises = telling && cost[k] > before[k];
      if (ended || hopeless || rises) continue;
      still.push_back(growing[k]);
      remaining_costs.push_back(cost[k]);
    }
    growing = std::move(still);
    before = std::move(remaining_costs);
    if (telling && std::min(next, count_cost) >= worth_trying(step)) break;
  }
}

SkinnedCandidate BoneSearch::candidate(Growth& growth, Growth::Bones& bones,
                                       double step) const {
  if (!bones.settled) {
    bones.settled.emplace(bones.state);
    bones.settled->settle();
  }
  const std::uint32_t influences = growth.influences == 1 ? 1 : max_influences_;
  return {growth.fit->rig(*bones.settled, influences, step),
          {bones.count, growth.influences},
          settings_};
}

// Returns a bone that rotates or one that only translates, whichever is expected to cost less.
Rig BoneSearch::guess_one_bone(double step) {
  start_all();
  const Growth& any = growths_.front();
  const Growth::Bones& one = any.bones.front();
  const bool rotates = expected_cost(any, one, step) < translation_cost(step);
  return rotates ? any.fit->rig(one.state, 1, step) : translation_rig(frames_);
}

SkinnedCandidate BoneSearch::one_bone(double step) {
  return {guess_one_bone(step), {}, settings_};
}

SkinnedTrial BoneSearch::try_one_bone(const SkinnedTrials& trials) {
  start_all();
  const bool keeps = one_ && is_within(kDraftServes, one_->step_of_components, trials.step());
  const bool is_slow = context_.settings.preset == Preset::kSlow;
  SkinnedTrial best =
      trials.run(is_slow ? SkinnedCandidate{translation_rig(frames_), {}, settings_}
                         : one_bone(trials.step()),
                 keeps ? &*one_ : nullptr);
  if (is_slow) {
    const Growth& any = growths_.front();
    const Rig turning = any.fit->rig(any.bones.front().state, 1, trials.step());
    best = *cheaper(std::move(best), trials.run({turning, {}, settings_}));
  }
  actual_to_expected_ = std::min(best.cost / translation_cost(trials.step()), 1.0);
  return best;
}

SkinnedTrial BoneSearch::try_requested(const SkinnedTrials& trials) {
  BestTrial best;
  for (std::uint32_t influences = 1; influences <= search_influences_; ++influences) {
    Growth growth = start(influences);
    growth.fit->grow(context_.settings.main.bones);
    growth.fit->settle();
    Growth::Bones bones{0, growth.fit->state(), {}};
    best = cheaper(std::move(best), trials.run(candidate(growth, bones, trials.step())));
  }
  return std::move(*best);
}

// Finds the rig of the input or, if there is none, recovers one from the frames. Returns
// whether there is any.
bool BoneSearch::find_given_rig(double step) {
  constexpr double kCertain = 0.99;  // fixed: of the vertices; fitted bones are no rivals then
  if (is_given_rig_known_) return given_rig_ != nullptr;
  is_given_rig_known_ = true;
  const EncoderSettings& settings = context_.settings;
  if (settings.main.bones != 0) return false;
  given_rig_ = frames_.input_rig;
  if (given_rig_ && frames_.rigid_rig)
    given_rig_ = better_rig(given_rig_, frames_.rigid_rig, step);
  is_given_rig_certain_ = given_rig_ != nullptr;
  const bool recovers =
      !given_rig_ && settings.preset != Preset::kFast && settings.main.influences == 0;
  if (!recovers) return given_rig_ != nullptr;
  if (auto recovered = recover_rig(frames_, context_.triangles)) {
    is_given_rig_certain_ = recovered->explained >= kCertain;
    given_rig_ = std::make_shared<const Rig>(std::move(recovered->rig));
  }
  return given_rig_ != nullptr;
}

// Returns the rig that takes fewer bits at equal error: stretches may not be worth theirs.
std::shared_ptr<const Rig> BoneSearch::better_rig(std::shared_ptr<const Rig> first,
                                                  std::shared_ptr<const Rig> second,
                                                  double step) const {
  const SkinnedTrials trials(context_, frames_, step);
  std::array<double, 2> bits{};
  for_each(2, [&](std::size_t i) {
    const SkinnedTrial draft = trials.run(given_rig(i == 0 ? *first : *second, step));
    bits[i] = bits_at_equal_error(draft.bits, draft.error);
  });
  return bits[1] < bits[0] ? second : first;
}

SkinnedCandidate BoneSearch::given_rig(const Rig& given, double step) const {
  Rig rig = given;
  const double worth =
      lambda(step) * expected_bone_bits(unsteadiness(frames_), frames_, rig.bones.size(), step);
  fix_joints(0.5 * worth, rig);  // saves three of six values per pose
  return {std::move(rig), {}, settings_};
}

// Whether no bones need to be fitted, as the given rig is certain, and clearly better than a
// single bone. In tiny GOFs, where a fit takes a tenth of a second, it is compared with all
// others.
bool BoneSearch::follows_given_rig(double step) {
  constexpr std::uint64_t kTiny = std::uint64_t{1} << 15;  // fixed: time; positions
  if (follows_given_rig_) return *follows_given_rig_;
  const bool is_tiny = context_.settings.preset != Preset::kFast &&
                       std::uint64_t{frames_.num_vertices} * frames_.num_frames <= kTiny;
  if (is_tiny || !find_given_rig(step) || !is_given_rig_certain_)
    return follows_given_rig_.emplace(false);
  start_all();
  const SkinnedTrials trials(context_, frames_, step);
  std::array<BestTrial, 2> drafts;
  for_each(2, [&](std::size_t i) {
    drafts[i] = trials.run(i == 0 ? one_bone(step) : given_rig(*given_rig_, step));
  });
  return follows_given_rig_.emplace(is_clearly_better(*drafts[1], *drafts[0]));
}

// Returns bones that may be worth their bits, the most likely first: their expected cost is
// less than that of a single bone, and exceeds the least by no more than estimates are wrong.
// In small GOFs, where a draft takes a tenth of a second, unlikely ones follow, one for each
// number of influences, since estimates from few vertices are imprecise.
std::vector<BoneSearch::Candidate> BoneSearch::candidates(double step) {
  // tuned: Candidates are encoded as drafts, at most this many.
  constexpr std::size_t kDrafts = 3;
  constexpr std::uint64_t kSmall = std::uint64_t{1} << 16;  // fixed: time; positions
  std::vector<Candidate> list;
  for (std::size_t g = 0; g < growths_.size(); ++g) {
    for (std::size_t i = 1; i < growths_[g].bones.size(); ++i) {
      list.push_back({g, i, expected_cost(growths_[g], growths_[g].bones[i], step)});
    }
  }
  std::stable_sort(list.begin(), list.end(), [](const Candidate& a, const Candidate& b) {
    return a.expected < b.expected;
  });
  if (context_.settings.preset == Preset::kSlow) return list;
  const bool is_small = std::uint64_t{frames_.num_vertices} * frames_.num_frames <= kSmall;
  std::vector<Candidate> kept;
  std::vector<bool> has_growth(growths_.size(), !is_small);
  for (const Candidate& c : list) {
    const bool is_likely =
        kept.size() < kDrafts &&
        c.expected < std::min(worth_trying(step), (1.0 + kTryMargin) * list.front().expected);
    if (is_likely || !has_growth[c.growth]) {
      kept.push_back({c.growth, c.bones, c.expected, is_likely});
    }
    has_growth[c.growth] = true;
  }
  return kept;
}

// Exchanges more of the bones of a candidate; none if that was done before.
BestTrial BoneSearch::polish(const SkinnedTrials& trials, const Candidate& chosen) {
  Growth& growth = growths_[chosen.growth];
  Growth::Bones& bones = growth.bones[chosen.bones];
  if (bones.polished) return std::nullopt;
  growth.fit->return_to(bones.state);
  for (int i = 0; i < 2; ++i) growth.fit->settle();
  bones.state.take(growth.fit->state());
  bones.settled.reset();
  bones.polished = true;
  return trials.run(candidate(growth, bones, trials.step()));
}

SkinnedCandidate BoneSearch::likeliest(double step) {
  const Stage stage("bones");
  // tuned (off: 1): Bones that are not tried are used if they are expected to cost less than
  // this fraction of a single one, of which the expected cost is too high: it leaves out what
  // adaptive weights predict.
  constexpr double kWithoutTrial = 0.55;
  if (follows_given_rig(step)) return given_rig(*given_rig_, step);
  grow_all(step);
  const std::vector<Candidate> list = candidates(step);
  const bool fast = context_.settings.preset == Preset::kFast;
  const double max_cost = (fast ? kWithoutTrial : 1.0) * one_bone_cost(step);
  const bool has_bones =
      !list.empty() && list.front().is_likely && list.front().expected < max_cost;
  if (!has_bones) return one_bone(step);
  Growth& growth = growths_[list.front().growth];
  return candidate(growth, growth.bones[list.front().bones], step);
}

double BoneSearch::squared_spread() const { return growths_.front().fit->squared_spread(); }

// Whether the second draft takes fewer bits than the first if both are encoded as a whole, each
// at the step at which the wanted error is expected: drafts do not show how well the tracks of
// bones can be coded.
bool BoneSearch::is_better(const SkinnedTrial& second, const SkinnedTrial& first,
                           const SkinnedTrials& trials, double wanted_error) const {
  constexpr double kFarthest = 1e3;  // fixed: a guard against drafts that are far off
  const std::array<const SkinnedTrial*, 2> drafts{&first, &second};
  std::array<double, 2> bits{};
  for_each(2, [&](std::size_t i) {
    const double error = std::max(drafts[i]->error, kMinError);
    const double ratio = std::clamp(wanted_error / error, 1.0 / kFarthest, kFarthest);
    const SkinnedTrials at_error(context_, frames_,
                                 trials.step() * det_exp2(det_log2(ratio) / kErrorPower));
    const SkinnedTrial whole = at_error.whole(drafts[i]->candidate);
    bits[i] = bits_at_equal_error(whole.bits, whole.error);
  });
  return bits[1] < bits[0];
}

// Returns the draft with the fewest bits at equal error, compared with another that is about as
// good.
std::size_t BoneSearch::best_of(std::span<const BestTrial> drafts, const SkinnedTrials& trials,
                                std::optional<double> wanted_error) const {
  std::vector<double> bits;
  for (const BestTrial& draft : drafts) {
    bits.push_back(bits_at_equal_error(draft->bits, draft->error));
  }
  const auto first =
      static_cast<std::size_t>(std::min_element(bits.begin(), bits.end()) - bits.begin());
  std::size_t second = first;
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    const bool is_close = bits[i] <= (1.0 + kTryMargin) * bits[first] ||
                          drafts[i]->cost <= (1.0 + kTryMargin) * drafts[first]->cost;
    if (i == first || !is_close) continue;
    if (second == first || bits[i] < bits[second]) second = i;
  }
  if (second == first) return first;
  const double error =
      wanted_error.value_or(std::min(drafts[first]->error, drafts[second]->error));
  return is_better(*drafts[second], *drafts[first], trials, error) ? second : first;
}

// Whether a draft takes fewer bits than another by more than the error of drafts.
bool BoneSearch::is_clearly_better(const SkinnedTrial& draft, const SkinnedTrial& other) {
  return bits_at_equal_error(draft.bits, draft.error) <
         (1.0 - kTryMargin) * bits_at_equal_error(other.bits, other.error);
}

SkinnedTrial BoneSearch::search(const SkinnedTrials& trials,
                                std::optional<double> wanted_error) {
  if (context_.settings.main.bones > 0) return try_requested(trials);
  if (follows_given_rig(trials.step())) {
    BestTrial one = try_one_bone(trials);
    BestTrial many = trials.run(given_rig(*given_rig_, trials.step()));
    progress_(kCompared);
    std::array<BestTrial, 2> both{std::move(one), std::move(many)};
    return std::move(*both[best_of(both, trials, wanted_error)]);
  }
  grow_all(trials.step());
  std::vector<BestTrial> drafts;
  drafts.emplace_back(try_one_bone(trials));
  if (find_given_rig(trials.step())) {
    drafts.emplace_back(trials.run(given_rig(*given_rig_, trials.step())));
  }
  const std::size_t num_given = drafts.size();  // not fitted
  const std::vector<Candidate> list = candidates(trials.step());
  drafts.resize(num_given + list.size());
  std::atomic<std::size_t> done = 0;
  for_each(list.size(), [&](std::size_t i) {
    Growth& growth = growths_[list[i].growth];
    Growth::Bones& bones = growth.bones[list[i].bones];
    drafts[num_given + i] = trials.run(candidate(growth, bones, trials.step()));
    const auto part = static_cast<double>(++done) / static_cast<double>(list.size());
    progress_(kFitted + (kDrafted - kFitted) * part);
  });
  const auto num_likely = static_cast<std::size_t>(
      std::count_if(list.begin(), list.end(), [](const Candidate& c) { return c.is_likely; }));
  const std::span<const BestTrial> all = drafts;
  std::size_t best = best_of(all.first(num_given + num_likely), trials, wanted_error);
  for (std::size_t i = num_given + num_likely; i < drafts.size(); ++i) {
    if (is_clearly_better(*drafts[i], *drafts[best])) best = i;
  }
  progress_(kCompared);
  BestTrial cheapest = std::move(drafts[best]);
  if (best >= num_given && context_.settings.preset == Preset::kSlow) {
    BestTrial polished = polish(trials, list[best - num_given]);
    if (polished) cheapest = cheaper(std::move(cheapest), std::move(*polished));
  }
  return std::move(*cheapest);
}

}  // namespace rlpc
