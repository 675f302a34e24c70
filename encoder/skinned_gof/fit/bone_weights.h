// Few bone weights of a vertex: not negative, of sum 1.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/skinned_gof/fit/rig.h"

namespace rlpc {

struct BoneWeights {
  std::vector<RigWeight> weights;  // `bone` is the candidate's number; heaviest first
  double error = 0.0;              // squared, over the frames
};

// Weights that lower the squared error w^T gram w of a blend, where gram holds the products of
// the candidates' deviations. Candidates come in one at a time, the best first, as long as each
// lowers the error by more than `error_per_influence`; one whose weight would be negative goes.
//
//   gram            [count][stride], row-major, positive semidefinite
//   max_influences  1 to kMaxExtraBones
BoneWeights sparse_weights(std::span<const double> gram, std::size_t stride, std::size_t count,
                           std::size_t max_influences, double error_per_influence);

}  // namespace rlpc
