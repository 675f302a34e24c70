// The choice of bones for a skinned GOF.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "encoder/gof/gof_frames.h"
#include "encoder/skinned_gof/fit/bone_fit.h"
#include "encoder/skinned_gof/fit/rig.h"
#include "encoder/skinned_gof/search/skinned_context.h"
#include "encoder/skinned_gof/search/skinned_trial.h"

namespace rlpc {

// All are for the step of the trials. Everything is kept by reference.
class BoneSearch {
 public:
  BoneSearch(const SkinnedContext& context, const GofFrames& frames,
             const SkinnedTrials& trials);

  // One bone that turns, if that is expected to cost less, else one that does not; unseen.
  Rig guess_one_bone() const;
  // The best of all numbers of bones.
  SkinnedTrial search() const;
  // The best number of bones near the one that was best for another step: more for a finer
  // step, fewer, and after the fewest one, for a coarser.
  SkinnedTrial search_near(const BoneCounts& counts, bool finer) const;

 private:
  // What numbers of bones are expected to cost, by a small sample.
  struct Estimate {
    std::uint32_t count = 0;                                // of the bones that cost least
    double cost = std::numeric_limits<double>::infinity();  // expected of these
    double translation = 0.0;                               // the same without bones
    std::vector<double> costs;                              // the same of all numbers tried
  };

  // Those with vertices that follow one bone, two, ...
  struct Estimates {
    std::vector<Estimate> of_influences;  // [influences - 1]
    double least = std::numeric_limits<double>::infinity();
  };

  BoneFit fit(std::size_t influences) const;
  BoneFit quick_fit(std::size_t influences) const;
  bool grow(BoneFit& fit, std::uint32_t count) const;
  SkinnedTrial run(Rig rig, const BoneCounts& counts) const;
  Estimate estimate(std::size_t influences) const;
  Estimates estimates() const;
  SkinnedTrial try_one_bone() const;
  BestTrial try_asked() const;
  BestTrial try_estimated(BestTrial best, std::uint32_t influences, const Estimate& estimate,
                          double without) const;
  BestTrial try_counts(BestTrial best, BoneFit& full, std::uint32_t influences,
                       std::span<const std::uint32_t> counts, std::uint32_t likely) const;

  const SkinnedContext& context_;
  const GofFrames& frames_;
  const SkinnedTrials& trials_;
  SkinnedSettings settings_;
  std::uint32_t max_influences_;
  std::uint32_t search_influences_;  // at most so many while bones are looked for
};

}  // namespace rlpc
