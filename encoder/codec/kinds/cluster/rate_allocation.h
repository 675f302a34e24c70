// Allocates components to clusters along convex hulls of rate and distortion (Amjoun and
// Strasser 2007, 3.4; incremental hulls after Wagner and Saupe 2000).
#pragma once

#include <cstddef>
#include <vector>

namespace rlpc {

struct RdPoint {
  double rate = 0.0;        // vectors or estimated bits; rises with the number of components
  double distortion = 0.0;  // squared error; usually falls with the number of components
};

// Point l is the result of coding l components; every curve has at least point 0.
using RdCurve = std::vector<RdPoint>;

// Returns the number of components of each cluster. Advances along the lower convex hulls,
// steepest slope first, as long as the total rate stays within total_rate.
std::vector<std::size_t> allocate_within(const std::vector<RdCurve>& curves, double total_rate);

// Returns the number of components with the lowest Lagrangian cost. Advances along the lower
// convex hull while a unit of rate lowers the distortion by more than lambda.
std::size_t allocate_by_slope(const RdCurve& curve, double lambda);

}  // namespace rlpc
