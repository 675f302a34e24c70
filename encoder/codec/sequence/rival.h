// The result that a further search has to beat, and when that search has no prospect of it.
#pragma once

#include <cstdint>

#include "encoder/codec/sequence/span_batch.h"
#include "encoder/codec/settings.h"

namespace rlpc {

class Rival {
 public:
  // Keeps references to both. best: of the whole sequence, with metrics of its frames.
  Rival(const Target& target, const BatchTrial& best) : target_(target), best_(best) {}

  // Whether a search has no prospect of a smaller result at the target after this encoding of
  // the frames first, first + 1 ... of the sequence: at equal error, it takes more bytes than
  // the best result spends on these frames, by a factor of more than `far` and what the unlike
  // errors make uncertain.
  bool is_out_of_reach(const BatchTrial& trial, std::uint32_t first, double far) const;
  // Whether a GOF of the best result needs so many trajectories or components that those of
  // all vertices are no good basis, or is of frames.
  bool has_high_rank() const;

 private:
  const Target& target_;
  const BatchTrial& best_;
};

}  // namespace rlpc
