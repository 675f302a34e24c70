// Linear maps as rotations after stretches (8.12.5).
#pragma once

#include <array>
#include <span>

#include "common/codec/kinds/skinned/recon/quaternion.h"
#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"
#include "encoder/codec/spans/rig.h"

namespace rlpc {

Eigen::Matrix3d matrix_of(const AxisImages& images);
Eigen::Matrix3d matrix_of(const BoneAxes& decoded);
AxisImages images_of(const Eigen::Matrix3d& matrix);

// Returns the map X for which after * X is the whole; where `after` has flattened an axis, the
// one nearest to `before`, that of the previous frame.
Eigen::Matrix3d quotient(const Eigen::Matrix3d& after, const Eigen::Matrix3d& whole,
                         const Eigen::Matrix3d& before);

// Returns the rotation nearest to a map; of a map that has flattened axes, the one nearest to
// `before`.
Eigen::Matrix3d rotation_of(const Eigen::Matrix3d& map, const Eigen::Matrix3d& before);

// Returns the factors by which a map stretches along the columns of `along` before it rotates.
std::array<double, 3> stretch_along(const Eigen::Matrix3d& along,
                                    const Eigen::Matrix3d& rotation,
                                    const Eigen::Matrix3d& map);

// Returns the rotation whose columns make symmetric matrices as diagonal as one rotation can:
// the axes of a stretch, from the stretches of all frames. By plane rotations (Cardoso and
// Souloumiac 1996).
Eigen::Matrix3d common_axes(std::span<const Eigen::Matrix3d> symmetric);

}  // namespace rlpc
