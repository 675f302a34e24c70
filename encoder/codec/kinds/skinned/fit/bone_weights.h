// Sparse bone weights of a vertex: a few non-negative weights with sum 1.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/codec/spans/rig.h"

namespace rlpc {

struct BoneWeights {
  std::vector<RigWeight> weights;  // heaviest first; `bone` is the index of the candidate
  double error = 0.0;              // squared error over the frames
};

// Minimises the squared error w^T gram w of a blend of candidate bones. gram is the Gram matrix
// of the candidates' errors. Candidates are added greedily, the best first, as long as each
// lowers the squared error by more than `error_per_influence`; those with negative weights are
// removed.
//
//   gram            [count][stride], row-major, positive semidefinite
//   max_influences  1 to kMaxExtraBones
BoneWeights sparse_weights(std::span<const double> gram, std::size_t stride, std::size_t count,
                           std::size_t max_influences, double error_per_influence);

}  // namespace rlpc
