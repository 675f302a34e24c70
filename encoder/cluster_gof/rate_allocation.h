// How many components each cluster gets (Amjoun and Strasser 2007, 3.4; convex hulls computed
// as they grow, after Wagner and Saupe 2000).
#pragma once

#include <cstddef>
#include <vector>

namespace rlpc {

struct RdPoint {
  double rate = 0.0;        // vectors or estimated bits, rising with the number of components
  double distortion = 0.0;  // squared error, falling
};

// Point l stands for l components; every curve has at least the point of 0 components.
using RdCurve = std::vector<RdPoint>;

// Steps along the lower convex hulls, steepest first, while the total rate stays within the
// budget.
std::vector<std::size_t> allocate_within(const std::vector<RdCurve>& curves, double total_rate);

// Steps along the lower convex hull as long as a unit of rate lowers the distortion by lambda.
std::size_t allocate_by_slope(const RdCurve& curve, double lambda);

}  // namespace rlpc
