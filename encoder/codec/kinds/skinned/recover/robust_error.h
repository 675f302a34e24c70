// Sums over points that errors far above a scale affect little: some points follow bones that
// are not known, and no fit explains them.
#pragma once

#include <span>
#include <vector>

namespace rlpc {

// Returns twice the error that three fifths of the points do not exceed, or kFinest.
//
//   errors  RMS of a coordinate of each point, extents; at least one
double robust_scale(std::vector<double> errors);

// Returns the sum of log2(1 + (error / scale)^2).
double robust_cost(std::span<const double> errors, double scale);

// Returns the weight of the equations of a point with an error, so that steps lower that sum.
double robust_weight(double error, double scale);

}  // namespace rlpc
