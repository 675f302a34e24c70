// Random points and motions, the same on every machine, for tests of bones.
#pragma once

#include <random>

#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"

namespace rlpc {

class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : random_(seed) {}
  double value() { return static_cast<double>(random_()) / 2147483648.0 - 1.0; }  // -1 to 1
  Vec3d point() {
    const double x = value();
    const double y = value();
    return {x, y, value()};
  }
  // Returns a motion within about `size`, in radians and units, of the identity.
  Motion motion(double size) {
    Motion m;
    const Vec3d turn = 0.5 * size * point();
    m.leftCols<3>() = rotation_matrix(normalised({1.0, turn(0), turn(1), turn(2)}));
    m.col(3) = size * point();
    return m;
  }
  Eigen::Matrix3d matrix() {
    Eigen::Matrix3d m;
    for (Eigen::Index i = 0; i < 3; ++i) m.col(i) = point();
    return m;
  }
  Eigen::Matrix3d rotation() {
    const Vec3d p = point();
    return rotation_matrix(normalised({value(), p(0), p(1), p(2)}));
  }

 private:
  std::mt19937 random_;
};

}  // namespace rlpc
