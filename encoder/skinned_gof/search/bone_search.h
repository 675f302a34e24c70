// Chooses the bones of a skinned GOF: how many there are, and how many each vertex may follow.
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

// All results are for the step of the trials.
class BoneSearch {
 public:
  // Keeps references to all arguments.
  BoneSearch(const SkinnedContext& context, const GofFrames& frames,
             const SkinnedTrials& trials);

  // A single bone, without encoding it: whichever is expected to cost less, one that rotates or
  // one that only translates.
  Rig guess_one_bone() const;
  // The cheapest trial over all numbers of bones.
  SkinnedTrial search() const;

 private:
  // Expected costs of different numbers of bones, from a small sample.
  struct Estimate {
    std::uint32_t count = 0;                                // the number that costs least
    double cost = std::numeric_limits<double>::infinity();  // its expected cost
    double translation = 0.0;   // expected cost of a single bone that only translates
    std::vector<double> costs;  // expected costs of all numbers, as far as tried
  };

  // Estimates for each maximum number of bones per vertex.
  struct Estimates {
    std::vector<Estimate> of_influences;                     // [influences - 1]
    double least = std::numeric_limits<double>::infinity();  // the lowest cost of all
  };

  BoneFit fit(std::size_t influences) const;
  BoneFit quick_fit(std::size_t influences) const;
  bool grow(BoneFit& fit, std::uint32_t count) const;
  SkinnedTrial run(Rig rig, const BoneCounts& counts) const;
  Estimate estimate(std::size_t influences) const;
  Estimates estimates() const;
  SkinnedTrial try_one_bone() const;
  BestTrial try_requested() const;
  SkinnedTrial search_all() const;
  SkinnedTrial search_likely() const;
  BestTrial try_estimated(std::uint32_t influences, const Estimate& estimate) const;
  BestTrial try_counts(BoneFit& full, std::uint32_t influences,
                       std::span<const std::uint32_t> counts, std::uint32_t likely) const;

  const SkinnedContext& context_;
  const GofFrames& frames_;
  const SkinnedTrials& trials_;
  SkinnedSettings settings_;
  std::uint32_t max_influences_;
  std::uint32_t search_influences_;  // maximum bones per vertex while bones are fitted
};

}  // namespace rlpc
