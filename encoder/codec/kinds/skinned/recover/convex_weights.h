// Weights of a convex combination of a few errors.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rlpc {

// Returns the non-negative weights w with sum 1 that minimise w^T gram w, with at most
// max_count of them above 0: exactly, unless more would be needed; then the largest are kept
// and solved for again.
//
//   gram  [count][count], positive semidefinite
std::vector<double> convex_weights(std::span<const double> gram, std::size_t count,
                                   std::size_t max_count);

}  // namespace rlpc
