// Expects that matrices are rotations, for tests of bones.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"

namespace rlpc {

inline void expect_rotation(const Eigen::Matrix3d& r) {
  EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12) << r;
  EXPECT_NEAR(r.determinant(), 1.0, 1e-12);
}

inline void expect_rigid(const std::vector<Motion>& motions) {
  for (const Motion& m : motions) {
    expect_rotation(m.leftCols<3>());
    EXPECT_TRUE(m.allFinite());
  }
}

}  // namespace rlpc
