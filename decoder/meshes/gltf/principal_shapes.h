// Morph targets for the moves of vertices over time.
#pragma once

#include <cstddef>

#include "decoder/meshes/gltf/eigen.h"

namespace rlpc {

inline constexpr float kWeightUnit = 1.0F / 32767;

struct PrincipalShapes {
  // [3 * num_vertices][target]: bytes, whole multiples of `unit` from -127 to 127.
  Eigen::MatrixXf targets;
  float unit = 1;  // 1/127 or 1
  // [target][frame]; multiples of kWeightUnit from -1 to 1 if has_short_weights.
  Eigen::MatrixXf weights;
  bool has_short_weights = false;
};

// When to stop: once the targets leave no more than other_rms, where the size of the file times
// the RMS of all errors of a vertex is smallest.
struct TargetPrice {
  double file_bytes = 0;        // without targets
  double written_vertices = 1;  // for each vertex
  double other_rms = 0;         // of errors that targets leave as they are
};

// About as few targets as possible with which the RMS of what remains of the moves of a vertex
// is at most `rms`; no more than max_targets. moves: [3 * num_vertices][frame].
PrincipalShapes principal_shapes(Eigen::MatrixXf moves, double rms, std::size_t max_targets);
// No more than are worth their price.
PrincipalShapes principal_shapes(Eigen::MatrixXf moves, double rms, std::size_t max_targets,
                                 const TargetPrice& price);
// With that unit. Sets moves to what remains of them. thinned: as `rms`, but decides what
// targets leave out.
PrincipalShapes principal_shapes_of(Eigen::MatrixXf& moves, double rms, double thinned,
                                    std::size_t max_targets, float unit);

}  // namespace rlpc
