// The result that a further search has to beat.
#pragma once

#include "encoder/codec/sequence/span_batch.h"
#include "encoder/codec/settings.h"

namespace rlpc {

class Rival {
 public:
  // Keeps references to both. best: the whole sequence, with metrics of its frames. contested:
  // whether it was encoded as several kinds of GOF.
  Rival(const Target& target, const BatchTrial& best, bool contested)
      : target_(target), best_(best), contested_(contested) {}

  // Whether its kind of GOF was clearly the best.
  bool is_uncontested() const { return !contested_; }

  // Whether a search cannot be expected to find a smaller result at the target, after this
  // encoding of the sequence: at equal error, it takes more bytes than the best result by a
  // factor above `far` and the uncertainty from different errors.
  bool is_out_of_reach(const BatchTrial& trial, double far) const;

 private:
  const Target& target_;
  const BatchTrial& best_;
  bool contested_;
};

}  // namespace rlpc
