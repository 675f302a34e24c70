// Morph targets for the moves of vertices over time.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

namespace rlpc {

// Their values are bytes: whole multiples of a unit, which is 1/127 or 1, from -127 to 127.
struct PrincipalShapes {
  Eigen::MatrixXf targets;   // [3 * num_vertices][target]
  Eigen::MatrixXf weights;   // [target][frame]
  std::vector<float> units;  // [target]
};

// About as few targets as possible with which the RMS of what remains of the moves of a vertex
// is at most `rms`; no more than max_targets. moves: [3 * num_vertices][frame].
PrincipalShapes principal_shapes(Eigen::MatrixXf moves, double rms, std::size_t max_targets);

}  // namespace rlpc
