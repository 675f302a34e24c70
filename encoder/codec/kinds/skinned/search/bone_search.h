// Chooses the number of bones of a skinned GOF, and how many of them each vertex may follow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_fit.h"
#include "encoder/codec/kinds/skinned/search/skinned_context.h"
#include "encoder/codec/kinds/skinned/search/skinned_trial.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Bones do not depend on the step and are fitted once. Which of them are worth their bits does
// depend on it, so a search may be repeated for another step.
class BoneSearch {
 public:
  // Keeps references to all arguments.
  BoneSearch(const SkinnedContext& context, const SpanFrames& frames);

  // Sets a function that is called after each stage with the fraction done, 0 to 1, of all work
  // on the span.
  void set_progress(const std::function<void(double)>& progress) { progress_ = progress; }
  // Returns a single bone without encoding it: one that rotates or one that only translates,
  // whichever is expected to cost less.
  Rig guess_one_bone(double step);
  // Returns the candidate that is expected to be cheapest.
  SkinnedCandidate likeliest(double step);
  // Returns the analysis of a draft of one_bone(), if likeliest() needed one; else null.
  const SkinnedAnalysis* analysis_of_one() const { return one_ ? &*one_ : nullptr; }
  // Returns the best trial over all numbers of bones. wanted_error: squared, if it is the
  // target.
  SkinnedTrial search(const SkinnedTrials& trials, std::optional<double> wanted_error);
  // Returns about the sum of squared distances of all vertices from the centres of their
  // frames; call it after a trial.
  double squared_spread() const;
  // Frees the fitted bones, after the last search.
  void release() {
    growths_.clear();
    one_.reset();
    given_rig_.reset();
  }

 private:
  // Bones of different numbers, with a maximum number of them for each vertex.
  struct Growth {
    std::uint32_t influences;
    std::unique_ptr<BoneFit> fit;
    struct Bones {
      std::uint32_t count = 0;  // number asked for
      BoneSolver state;         // bones that can be exchanged
      ResidualSpectrum spectrum;
      std::optional<BoneSolver> settled = {};  // the same bones with the best rest positions
      bool polished = false;                   // further exchanges gain nothing
    };
    std::vector<Bones> bones = {};  // the first: a single bone
  };
  struct Candidate {
    std::size_t growth = 0;
    std::size_t bones = 0;  // index
    double expected = 0.0;  // cost
    bool is_likely = true;  // judged by that cost
  };

  Growth start(std::uint32_t influences) const;
  void start_all();
  void grow_all(double step);
  double translation_cost(double step) const;
  double one_bone_cost(double step) const;
  double worth_trying(double step) const;
  double expected_cost(const Growth& growth, const Growth::Bones& bones, double step) const;
  SkinnedCandidate one_bone(double step);
  SkinnedCandidate candidate(Growth& growth, Growth::Bones& bones, double step) const;
  SkinnedTrial try_one_bone(const SkinnedTrials& trials);
  SkinnedTrial try_requested(const SkinnedTrials& trials);
  bool find_given_rig(double step);
  std::shared_ptr<const Rig> better_rig(std::shared_ptr<const Rig> first,
                                        std::shared_ptr<const Rig> second, double step) const;
  SkinnedCandidate given_rig(const Rig& given, double step) const;
  bool follows_given_rig(double step);
  std::vector<Candidate> candidates(double step);
  bool is_better(const SkinnedTrial& second, const SkinnedTrial& first,
                 const SkinnedTrials& trials, double wanted_error) const;
  static bool is_clearly_better(const SkinnedTrial& draft, const SkinnedTrial& other);
  std::size_t best_of(std::span<const BestTrial> drafts, const SkinnedTrials& trials,
                      std::optional<double> wanted_error) const;
  BestTrial polish(const SkinnedTrials& trials, const Candidate& chosen);

  const SkinnedContext& context_;
  const SpanFrames& frames_;
  SkinnedSettings settings_;
  std::uint32_t max_influences_;
  std::uint32_t search_influences_;  // maximum bones per vertex while bones are fitted
  std::vector<Growth> growths_;
  ResidualSpectrum translation_;  // for a single bone that only translates
  // Ratio of the costs of a single bone: the expected cost ignores what adaptive weights
  // predict. At most 1, as other errors of the estimate are common to all numbers of bones.
  double actual_to_expected_ = 1.0;
  bool is_compared_ = false;              // actual_to_expected_ is known
  std::shared_ptr<const Rig> given_rig_;  // of the input, or recovered from the frames
  bool is_given_rig_known_ = false;
  bool is_given_rig_certain_ = false;  // of the input, or it moves nearly all vertices exactly
  std::optional<bool> follows_given_rig_;  // none: not yet known
  std::optional<SkinnedAnalysis> one_;     // draft of a single bone
  std::function<void(double)> progress_ = [](double) {};
};

}  // namespace rlpc
