// Chooses the bones of a skinned GOF: how many there are, and how many each vertex may follow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
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
  // A fit, and the Lagrangian cost that its sample lets expect.
  struct Candidate {
    std::unique_ptr<BoneFit> fit;
    BoneCounts counts;
    double expected = 0.0;
  };
  // Candidates, and the expected cost of a single bone from the same sample.
  struct Candidates {
    std::vector<Candidate> list;
    double of_one = std::numeric_limits<double>::infinity();
  };

  BoneFit fit(std::size_t influences, std::uint32_t part) const;
  Candidates candidates_from(std::span<const BoneCounts> counts, std::uint32_t part,
                             bool settles) const;
  Candidates grown(std::uint32_t influences, std::span<const std::uint32_t> counts,
                   std::uint32_t part) const;
  SkinnedTrial run(Rig rig, const BoneCounts& counts) const;
  SkinnedTrial run(const Candidate& candidate) const;
  std::vector<SkinnedTrial> try_one_bone() const;
  BestTrial try_requested() const;
  SkinnedTrial search_by_samples() const;
  SkinnedTrial search_all() const;

  const SkinnedContext& context_;
  const GofFrames& frames_;
  const SkinnedTrials& trials_;
  SkinnedSettings settings_;
  std::uint32_t max_influences_;
  std::uint32_t search_influences_;  // maximum bones per vertex while bones are fitted
};

}  // namespace rlpc
