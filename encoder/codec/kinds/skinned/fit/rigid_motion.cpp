#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "encoder/codec/math/small_system.h"

namespace rlpc {

Eigen::Matrix3d rotation_matrix(const UnitQuaternion& unit) {
  const auto [w, x, y, z] = unit;
  Eigen::Matrix3d r;
  r << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return r;
}

UnitQuaternion normalised(const UnitQuaternion& q) {
  const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / n, q[1] / n, q[2] / n, q[3] / n};
}

// Horn (1987): the quaternion is the eigenvector of the largest eigenvalue of a 4 x 4 matrix.
UnitQuaternion nearest_rotation(const Eigen::Matrix3d& h) {
  const double size = h.cwiseAbs().maxCoeff();
  if (!(size > 0.0)) return {1, 0, 0, 0};
  const Eigen::Matrix3d s = h / size;
  Eigen::Matrix4d n;
  n(0, 0) = s(0, 0) + s(1, 1) + s(2, 2);
  n(1, 1) = s(0, 0) - s(1, 1) - s(2, 2);
  n(2, 2) = s(1, 1) - s(0, 0) - s(2, 2);
  n(3, 3) = s(2, 2) - s(0, 0) - s(1, 1);
  n(0, 1) = n(1, 0) = s(2, 1) - s(1, 2);
  n(0, 2) = n(2, 0) = s(0, 2) - s(2, 0);
  n(0, 3) = n(3, 0) = s(1, 0) - s(0, 1);
  n(1, 2) = n(2, 1) = s(0, 1) + s(1, 0);
  n(1, 3) = n(3, 1) = s(0, 2) + s(2, 0);
  n(2, 3) = n(3, 2) = s(1, 2) + s(2, 1);
  constexpr double kTurnLeast = 1e-12;  // fixed: rounding
  n(0, 0) += kTurnLeast;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n);
  const Eigen::Vector4d v = solver.eigenvectors().col(3);
  const double sign = v(0) < 0.0 ? -1.0 : 1.0;
  return normalised({sign * v(0), sign * v(1), sign * v(2), sign * v(3)});
}

Eigen::Matrix3d closest_rotation(const Eigen::Matrix3d& h, const Eigen::Matrix3d& start) {
  constexpr int kSteps = 2;       // fixed: Newton has then converged
  constexpr double kFar = 0.2;    // fixed: radians, where it converges
  constexpr double kFlat = 1e-6;  // fixed: part of the trace: a turn that is barely determined
  Eigen::Matrix3d r = start;
  for (int i = 0; i < kSteps; ++i) {
    // Newton step for trace(R^T h). x is a rotation vector applied after R:
    // (trace(k) I - (k + k^T) / 2) x = curl of k.
    const Eigen::Matrix3d k = h * r.transpose();
    const double trace = k(0, 0) + k(1, 1) + k(2, 2);
    SmallSystem<3> m;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto row = static_cast<Eigen::Index>(a);
      const auto next = static_cast<Eigen::Index>((a + 1) % 3);
      const auto last = static_cast<Eigen::Index>((a + 2) % 3);
      for (std::size_t b = 0; b < 3; ++b) {
        const auto col = static_cast<Eigen::Index>(b);
        m.a[a][b] = (a == b ? trace : 0.0) - 0.5 * (k(row, col) + k(col, row));
      }
      m.b[a] = k(last, next) - k(next, last);
    }
    const auto turn = solve_small(m, 3, kFlat * trace);
    if (!turn.is_unique) return rotation_matrix(nearest_rotation(h));
    const auto [x0, x1, x2] = turn.x;
    const double size2 = x2 * x2 + x1 * x1 + x0 * x0;
    if (!(size2 < kFar * kFar)) return rotation_matrix(nearest_rotation(h));
    r = rotation_matrix(normalised({1.0, 0.5 * x0, 0.5 * x1, 0.5 * x2})) * r;
  }
  return r;
}

UnitQuaternion rotation_quaternion(const Eigen::Matrix3d& rotation) {
  return nearest_rotation(rotation);
}

void MotionFit::add(const Vec3d& original, const Vec3d& image) {
  if (count_ == 0.0) {
    first_original_ = original;
    first_image_ = image;
  }
  const Vec3d a = original - first_original_;
  const Vec3d b = image - first_image_;
  count_ += 1.0;
  original_ += a;
  image_ += b;
  products_ += b * a.transpose();
}

Motion MotionFit::with_rotation(const Eigen::Matrix3d& rotation) const {
  Motion m;
  m.leftCols<3>() = rotation;
  m.col(3) = first_image_ + image_ / count_ - rotation * (first_original_ + original_ / count_);
  return m;
}

Motion MotionFit::motion() const {
  if (count_ == 0.0) {
    Motion m = Motion::Zero();
    m.leftCols<3>().setIdentity();
    return m;
  }
  return with_rotation(rotation_matrix(nearest_rotation(covariance())));
}

Motion MotionFit::motion_near(const Motion& start) const {
  if (count_ == 0.0) return motion();
  return with_rotation(closest_rotation(covariance(), start.leftCols<3>()));
}

}  // namespace rlpc
