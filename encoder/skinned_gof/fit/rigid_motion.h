// Rigid motions as matrices, and the one nearest to a set of point pairs.
#pragma once

// The same sums everywhere: fixed-size matrices, unrolled in order, never vectorised.
#ifndef EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_VECTORIZE
#endif
#include <Eigen/Core>
#include <array>

namespace rlpc {

using Vec3d = Eigen::Vector3d;
using Motion = Eigen::Matrix<double, 3, 4>;    // [R | t]: takes x to R x + t
using UnitQuaternion = std::array<double, 4>;  // w, x, y, z

inline Vec3d moved(const Motion& m, const Vec3d& x) { return m.leftCols<3>() * x + m.col(3); }

Eigen::Matrix3d rotation_matrix(const UnitQuaternion& unit);
UnitQuaternion normalised(const UnitQuaternion& q);
UnitQuaternion rotation_quaternion(const Eigen::Matrix3d& rotation);

// The rotation R that maximises trace(R^T h), where h is the sum of image * original^T; where
// that leaves a choice, the one that turns least.
UnitQuaternion nearest_rotation(const Eigen::Matrix3d& h);

// The same from a rotation near it, and faster.
Eigen::Matrix3d closest_rotation(const Eigen::Matrix3d& h, const Eigen::Matrix3d& start);

// Collects pairs of a point and its image; the motion minimises the sum of squared distances.
class MotionFit {
 public:
  void add(const Vec3d& original, const Vec3d& image);
  Motion motion() const;

 private:
  double count_ = 0.0;
  Vec3d original_ = Vec3d::Zero();
  Vec3d image_ = Vec3d::Zero();
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
  Vec3d first_original_ = Vec3d::Zero();  // sums are relative to the first pair
  Vec3d first_image_ = Vec3d::Zero();
};

}  // namespace rlpc
