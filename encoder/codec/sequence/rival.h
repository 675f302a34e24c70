// The result that a further search has to beat.
#pragma once

#include <cstdint>

#include "encoder/codec/sequence/span_batch.h"
#include "encoder/codec/settings.h"

namespace rlpc {

class Rival {
 public:
  // Keeps references to both. best: the whole sequence, with metrics of its frames.
  Rival(const Target& target, const BatchTrial& best) : target_(target), best_(best) {}

  // Whether a search cannot be expected to find a smaller result at the target, after this
  // encoding of the frames first, first + 1 ... of the sequence: at equal error, it takes more
  // bytes than the best result spends on these frames, by a factor above `far` and the
  // uncertainty from different errors.
  bool is_out_of_reach(const BatchTrial& trial, std::uint32_t first, double far) const;
  // Whether a GOF of the best result is an inter GOF, or needs so many trajectories or
  // components that a basis of all vertices is bad.
  bool has_high_rank() const;

 private:
  const Target& target_;
  const BatchTrial& best_;
};

}  // namespace rlpc
