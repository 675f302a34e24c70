// Rigid motions as matrices, and the rigid motion that best fits a set of point pairs.
#pragma once

// Unvectorised fixed-size matrices sum in the same order on every machine.
#ifndef EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_VECTORIZE
#endif
#include <Eigen/Core>
#include <array>

namespace rlpc {

using Vec3d = Eigen::Vector3d;
using Motion = Eigen::Matrix<double, 3, 4>;    // [R | t]: maps x to R x + t
using UnitQuaternion = std::array<double, 4>;  // w, x, y, z

// Returns (p, 1).
inline Eigen::Vector4d homogeneous(const Vec3d& p) { return {p(0), p(1), p(2), 1.0}; }
inline Vec3d moved(const Motion& m, const Vec3d& x) { return m.leftCols<3>() * x + m.col(3); }

// Returns the matrix that maps x to the cross product of a and x.
inline Eigen::Matrix3d cross_matrix(const Vec3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a(2), a(1), a(2), 0.0, -a(0), -a(1), a(0), 0.0;
  return m;
}

Eigen::Matrix3d rotation_matrix(const UnitQuaternion& unit);
UnitQuaternion normalised(const UnitQuaternion& q);
UnitQuaternion rotation_quaternion(const Eigen::Matrix3d& rotation);

// Returns the rotation R that maximises trace(R^T h), where h is the sum of image * original^T.
// If it is not unique, the one with the smallest angle.
UnitQuaternion nearest_rotation(const Eigen::Matrix3d& h);

// Returns the same, but faster if `start` is close to the result.
Eigen::Matrix3d closest_rotation(const Eigen::Matrix3d& h, const Eigen::Matrix3d& start);

// Accumulates pairs of a point and its image; motion() minimises the sum of squared distances.
class MotionFit {
 public:
  void add(const Vec3d& original, const Vec3d& image);
  Motion motion() const;
  // Returns the same, but faster if the rotation of `start` is close.
  Motion motion_near(const Motion& start) const;

 private:
  Eigen::Matrix3d covariance() const {
    return products_ - image_ * original_.transpose() / count_;
  }
  Motion with_rotation(const Eigen::Matrix3d& rotation) const;

  double count_ = 0.0;
  Vec3d original_ = Vec3d::Zero();
  Vec3d image_ = Vec3d::Zero();
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
  Vec3d first_original_ = Vec3d::Zero();  // sums are relative to the first pair
  Vec3d first_image_ = Vec3d::Zero();
};

}  // namespace rlpc
