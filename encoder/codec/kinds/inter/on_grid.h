// Rounds coordinates to the grid, in the same way wherever the encoder does so: frames that are
// coded without loss, repeated or compared must agree about ties.
#pragma once

#include <cmath>

namespace rlpc {

// Returns the grid step nearest to a coordinate in grid units; ties go up.
inline double on_grid(double value) { return std::floor(value + 0.5); }

}  // namespace rlpc
