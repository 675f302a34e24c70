// Morph targets for the moves of vertices over time.
#pragma once

#include <cstddef>

#include "decoder/meshes/gltf/eigen.h"

namespace rlpc {

inline constexpr float kWeightUnit = 1.0F / 32767;

struct PrincipalShapes {
  // [3 * num_vertices][target]: integers from -127 to 127, times `unit`.
  Eigen::MatrixXf targets;
  float unit = 1;  // 1/127 or 1
  // [target][frame]; multiples of kWeightUnit from -1 to 1 if has_short_weights.
  Eigen::MatrixXf weights;
  bool has_short_weights = false;
};

// Price of targets: once their residual is at most other_rms, targets are added while they
// reduce the size of the file times the RMS of all errors of a vertex.
struct TargetPrice {
  double file_bytes = 0;        // size without targets
  double written_vertices = 1;  // output vertices per vertex
  double other_rms = 0;         // RMS of errors that targets do not reduce
};

// Finds about as few targets as possible for a residual of at most `rms`, the RMS of a vertex;
// at most max_targets. moves: [3 * num_vertices][frame].
PrincipalShapes principal_shapes(Eigen::MatrixXf moves, double rms, std::size_t max_targets);
// Finds no more targets than are worth their price.
PrincipalShapes principal_shapes(Eigen::MatrixXf moves, double rms, std::size_t max_targets,
                                 const TargetPrice& price);
// Finds targets in a given unit, and sets moves to their residual. thinned: RMS that decides
// which vertices targets leave out.
PrincipalShapes principal_shapes_of(Eigen::MatrixXf& moves, double rms, double thinned,
                                    std::size_t max_targets, float unit);

}  // namespace rlpc
