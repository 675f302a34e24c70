#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "encoder/testing/random_points.h"
#include "encoder/testing/rigid.h"

namespace rlpc {
namespace {

const double kHalf = std::sqrt(0.5);

Eigen::Matrix3d rotation_about(const Vec3d& axis, double angle) {
  const Vec3d v = std::sin(0.5 * angle) * axis.normalized();
  return rotation_matrix({std::cos(0.5 * angle), v(0), v(1), v(2)});
}

void expect_quaternion(const UnitQuaternion& found, const UnitQuaternion& expected,
                       double tolerance = 1e-12) {
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found[k], expected[k], tolerance) << k;
}

double agreement(const Eigen::Matrix3d& r, const Eigen::Matrix3d& h) {
  return (r.transpose() * h).trace();
}

// Applies Kabsch's method: singular vectors of h, the last one negated if they reflect.
double best_agreement(const Eigen::Matrix3d& h) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3d& s = svd.singularValues();
  const double det = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return s(0) + s(1) + (det < 0.0 ? -s(2) : s(2));
}

TEST(RotationMatrix, RotatesByTheQuaternion) {
  const Eigen::Matrix3d r = rotation_matrix({0.5, 0.5, 0.5, 0.5});  // x to y to z to x
  EXPECT_EQ(r * Vec3d(1, 2, 3), Vec3d(3, 1, 2));
  const Eigen::Matrix3d q = rotation_matrix({kHalf, 0, 0, kHalf});
  EXPECT_LT((q * Vec3d(1, 0, 0) - Vec3d(0, 1, 0)).norm(), 1e-15);
}

TEST(NearestRotation, ReproducesARotation) {
  const std::vector<UnitQuaternion> known{{1, 0, 0, 0},          {kHalf, kHalf, 0, 0},
                                          {kHalf, 0, -kHalf, 0}, {kHalf, 0, 0, kHalf},
                                          {0.5, 0.5, 0.5, 0.5},  {0.5, -0.5, 0.5, 0.5},
                                          {0.8, 0, 0.6, 0},      {0.1, 0.7, -0.5, 0.5}};
  for (const UnitQuaternion& q : known) {
    for (const double scale : {1.0, 1e-150, 1e150}) {
      expect_quaternion(nearest_rotation(scale * rotation_matrix(q)), q);
    }
    expect_quaternion(rotation_quaternion(rotation_matrix(q)), q);
  }
}

// Either of the two quaternions of a half turn is correct.
TEST(NearestRotation, ReproducesAHalfTurn) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3d h = -Eigen::Matrix3d::Identity();
    h(axis, axis) = 1.0;
    EXPECT_LT((rotation_matrix(nearest_rotation(h)) - h).norm(), 1e-9) << axis;
  }
}

TEST(NearestRotation, IsTheIdentityForAZeroMatrix) {
  expect_quaternion(nearest_rotation(Eigen::Matrix3d::Zero()), {1, 0, 0, 0}, 0.0);
}

// Mirrored points give a rotation, not a reflection; here the identity is the best one.
TEST(NearestRotation, IsARotationForAReflection) {
  const Eigen::Matrix3d h = Vec3d(3, 2, -1).asDiagonal();
  expect_quaternion(nearest_rotation(h), {1, 0, 0, 0});
  const Eigen::Matrix3d all = -Eigen::Matrix3d::Identity();  // any half turn is optimal
  const Eigen::Matrix3d r = rotation_matrix(nearest_rotation(all));
  expect_rotation(r);
  EXPECT_NEAR(agreement(r, all), 1.0, 1e-12);
}

// Rotation about the line of collinear points is arbitrary: the smallest angle is chosen.
TEST(NearestRotation, HasTheSmallestAngleForCollinearPoints) {
  const Vec3d x = Vec3d::UnitX();
  const Vec3d y = Vec3d::UnitY();
  expect_quaternion(nearest_rotation(y * x.transpose()), {kHalf, 0, 0, kHalf}, 1e-3);
  expect_quaternion(nearest_rotation(5.0 * x * x.transpose()), {1, 0, 0, 0}, 1e-3);
  const Eigen::Matrix3d back = rotation_matrix(nearest_rotation(-x * x.transpose()));
  expect_rotation(back);
  EXPECT_LT((back * x + x).norm(), 1e-9);
}

// No rotation gives a larger trace: neither Kabsch's nor thousands of random ones.
TEST(NearestRotation, MaximisesTheTrace) {
  RandomPoints random(1);
  std::vector<Eigen::Matrix3d> rotations;
  rotations.reserve(3000);
  for (int i = 0; i < 3000; ++i) rotations.push_back(random.rotation());
  int reflections = 0;
  for (int i = 0; i < 100; ++i) {
    Eigen::Matrix3d h = random.matrix();
    if (i % 4 == 1) h.col(2) = h.col(0) - 2.0 * h.col(1);             // a plane
    if (i % 4 == 2) h = random.point() * random.point().transpose();  // a line
    if (i % 4 == 3 && h.determinant() > 0.0) h.row(0) = -h.row(0).eval();
    if (h.determinant() < -1e-6) ++reflections;
    const UnitQuaternion q = nearest_rotation(h);
    EXPECT_GE(q[0], 0.0);
    const Eigen::Matrix3d r = rotation_matrix(q);
    expect_rotation(r);
    const double found = agreement(r, h);
    EXPECT_NEAR(found, best_agreement(h), 1e-9) << i;
    for (const Eigen::Matrix3d& other : rotations) ASSERT_LE(agreement(other, h), found + 1e-9);
  }
  EXPECT_GT(reflections, 20);
}

TEST(ClosestRotation, IsTheNearestRotationFromAnyStart) {
  RandomPoints random(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d start = random.rotation();
    constexpr double kAngles[] = {0.05, 0.1, 0.5, 1.0, 3.0};
    const Eigen::Matrix3d goal = rotation_about(random.point(), kAngles[i % 5]) * start;
    Eigen::Matrix3d spread = random.matrix();
    spread = spread * spread.transpose() + 0.2 * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d h = goal * spread;  // its nearest rotation is `goal`
    const Eigen::Matrix3d r = closest_rotation(h, start);
    expect_rotation(r);
    EXPECT_LT((r - goal).norm(), 1e-6) << i;
  }
}

TEST(ClosestRotation, IsARotationIfItIsAmbiguous) {
  RandomPoints random(3);
  for (int i = 0; i < 50; ++i) {
    const Vec3d from = random.point();
    const Vec3d to = random.point();
    const Eigen::Matrix3d start = random.rotation();
    const Eigen::Matrix3d r = closest_rotation(to * from.transpose(), start);
    expect_rotation(r);
    EXPECT_NEAR(agreement(r, to * from.transpose()), to.norm() * from.norm(), 1e-9);
    expect_rotation(closest_rotation(Eigen::Matrix3d::Zero(), start));
    const Eigen::Matrix3d opposite = closest_rotation(-start, start);  // the worst start
    expect_rotation(opposite);
    EXPECT_NEAR(agreement(opposite, -start), 1.0, 1e-9);
  }
}

double squared_error(const Motion& m, const std::vector<std::pair<Vec3d, Vec3d>>& pairs) {
  double sum = 0.0;
  for (const auto& [original, image] : pairs) sum += (moved(m, original) - image).squaredNorm();
  return sum;
}

Motion fit(const std::vector<std::pair<Vec3d, Vec3d>>& pairs) {
  MotionFit collected;
  for (const auto& [original, image] : pairs) collected.add(original, image);
  return collected.motion();
}

TEST(MotionFit, IsTheIdentityWithoutPairsAndATranslationWithOne) {
  Motion identity = Motion::Zero();
  identity.leftCols<3>().setIdentity();
  EXPECT_EQ(fit({}), identity);
  Motion shift = identity;
  shift.col(3) = Vec3d(4, -5, 6);
  EXPECT_EQ(fit({{{1, 2, 3}, {5, -3, 9}}}), shift);
  EXPECT_EQ(fit({{{1, 2, 3}, {5, -3, 9}}, {{1, 2, 3}, {5, -3, 9}}}), shift);
}

// Includes points far from the origin, where sums of products are large.
TEST(MotionFit, FindsTheMotionOfPoints) {
  RandomPoints random(4);
  for (const double far : {0.0, 1e6}) {
    Motion motion;
    motion.leftCols<3>() = random.rotation();
    motion.col(3) = Vec3d(far, -2.0, 3.0);
    std::vector<std::pair<Vec3d, Vec3d>> pairs;
    for (int i = 0; i < 5; ++i) {
      const Vec3d p = random.point() + Vec3d(0, far, 0);
      pairs.emplace_back(p, moved(motion, p));
    }
    const Motion found = fit(pairs);
    expect_rotation(found.leftCols<3>());
    EXPECT_LT((found.leftCols<3>() - motion.leftCols<3>()).norm(), 1e-8) << far;
    for (const auto& [p, image] : pairs) EXPECT_LT((moved(found, p) - image).norm(), 1e-8);
  }
}

// With pairs that no rigid motion explains, and with mirrored ones, no motion nearby is better.
TEST(MotionFit, HasTheLeastSquaredError) {
  RandomPoints random(5);
  for (int i = 0; i < 20; ++i) {
    std::vector<std::pair<Vec3d, Vec3d>> pairs;
    for (int k = 0; k < 6; ++k) {
      const Vec3d p = random.point();
      const Vec3d image = i % 2 == 0 ? random.point() : Vec3d(-p(0), p(1), p(2));
      pairs.emplace_back(p, image);
    }
    const Motion best = fit(pairs);
    expect_rotation(best.leftCols<3>());
    const double min = squared_error(best, pairs);
    for (int k = 0; k < 100; ++k) {
      const double size = k % 2 == 0 ? 0.01 : 1.0;
      Motion other = best;
      other.leftCols<3>() = rotation_about(random.point(), size) * best.leftCols<3>();
      EXPECT_GE(squared_error(other, pairs), min - 1e-12);
      other.col(3) += size * random.point();
      EXPECT_GE(squared_error(other, pairs), min - 1e-12);
    }
  }
}

}  // namespace
}  // namespace rlpc
