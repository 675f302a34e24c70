// Chooses the bones of a skinned GOF: how many there are, and how many each vertex may follow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "encoder/gof/gof_frames.h"
#include "encoder/skinned_gof/fit/bone_fit.h"
#include "encoder/skinned_gof/fit/rig.h"
#include "encoder/skinned_gof/search/skinned_context.h"
#include "encoder/skinned_gof/search/skinned_trial.h"

namespace rlpc {

// Bones do not depend on the step, and are fitted once. Which of them are worth their bits
// does, so that a search may be repeated for another step.
class BoneSearch {
 public:
  // Keeps references to all arguments.
  BoneSearch(const SkinnedContext& context, const GofFrames& frames);

  // A single bone, without encoding it: whichever is expected to cost less, one that rotates or
  // one that only translates.
  Rig guess_one_bone(double step);
  // The trial that is expected to be the cheapest.
  SkinnedTrial likeliest(const SkinnedTrials& trials);
  // The cheapest trial over all numbers of bones.
  SkinnedTrial search(const SkinnedTrials& trials);
  // The sum of squared distances of all vertices from the centres of their frames, about; after
  // a trial.
  double squared_spread() const;

 private:
  // Bones of different numbers, with a maximum number of them for each vertex.
  struct Growth {
    std::uint32_t influences;
    std::unique_ptr<BoneFit> fit;
    struct Bones {
      std::uint32_t count;  // that were asked for
      BoneSolver state;
      bool polished = false;  // there is nothing to gain from further exchanges
    };
    std::vector<Bones> bones = {};  // the first: a single one
  };
  struct Candidate {
    std::size_t growth;
    std::size_t bones;  // index
    double expected;    // cost
  };

  Growth start(std::uint32_t influences) const;
  void grow();
  void grow(std::span<const std::uint32_t> counts);
  Rig rig(Growth& growth, const BoneSolver& state, double step) const;
  SkinnedTrial run(const SkinnedTrials& trials, Rig rig, const BoneCounts& counts) const;
  SkinnedTrial try_one_bone(const SkinnedTrials& trials);
  SkinnedTrial try_requested(const SkinnedTrials& trials);
  std::vector<Candidate> candidates(double step);
  SkinnedTrial run_candidate(const SkinnedTrials& trials, const Candidate& candidate);
  BestTrial polish(const SkinnedTrials& trials, const Candidate& candidate);

  const SkinnedContext& context_;
  const GofFrames& frames_;
  SkinnedSettings settings_;
  std::uint32_t max_influences_;
  std::uint32_t search_influences_;  // maximum bones per vertex while bones are fitted
  std::vector<Growth> growths_;
};

}  // namespace rlpc
