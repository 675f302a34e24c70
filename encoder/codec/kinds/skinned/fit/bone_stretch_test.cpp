#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace rlpc {
namespace {

class RandomMaps {
 public:
  explicit RandomMaps(unsigned seed) : random_(seed) {}
  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  Eigen::Matrix3d rotation() {
    return rotation_matrix(normalised({number(), number(), number(), number()}));
  }

 private:
  std::mt19937 random_;
};

TEST(BoneStretch, CommonAxesMakeAllStretchesDiagonal) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    RandomMaps random(seed);
    const Eigen::Matrix3d axes = random.rotation();
    std::vector<Eigen::Matrix3d> stretches;
    for (int f = 0; f < 6; ++f) {
      Vec3d factors(random.number(), random.number(), random.number());
      if (seed % 3 == 0) factors(1) = factors(0);  // any two axes of a plane
      stretches.push_back(axes * factors.asDiagonal() * axes.transpose());
    }
    const Eigen::Matrix3d found = common_axes(stretches);
    EXPECT_NEAR((found.transpose() * found - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
    for (const Eigen::Matrix3d& s : stretches) {
      const Eigen::Matrix3d turned = found.transpose() * s * found;
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(turned(i, (i + 1) % 3), 0.0, 1e-9) << seed;
      }
    }
  }
}

TEST(BoneStretch, MapsAreRotationsAfterStretches) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    RandomMaps random(seed);
    const Eigen::Matrix3d along = random.rotation();
    const Eigen::Matrix3d rotation = random.rotation();
    const Vec3d factors(1.5 + random.number(), 1.5 + random.number(), 1.5 + random.number());
    const Eigen::Matrix3d map = rotation * along * factors.asDiagonal() * along.transpose();
    const Eigen::Matrix3d above = 0.5 * random.rotation();
    const Eigen::Matrix3d local = quotient(above, above * map, random.rotation());
    EXPECT_NEAR((local - map).norm(), 0.0, 1e-6) << seed;
    const auto found = stretch_along(along, rotation, local);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(found[static_cast<std::size_t>(i)], factors(i), 1e-6) << seed;
    }
  }
}

// A parent that has shrunk to nothing shows nothing of its children.
TEST(BoneStretch, WhatIsFlatStaysAsItWas) {
  RandomMaps random(1);
  const Eigen::Matrix3d nothing = Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d before = random.rotation();
  EXPECT_LT((quotient(nothing, nothing, before) - before).norm(), 1e-9);
  EXPECT_LT((rotation_of(nothing, before) - before).norm(), 1e-9);
  // Flat along y: the map of the other axes shows, and the turn about them.
  const Eigen::Matrix3d flat = Vec3d(1.0, 0.0, 1.0).asDiagonal();
  const Eigen::Matrix3d map = random.rotation();
  const Eigen::Matrix3d found = quotient(flat, flat * map, before);
  EXPECT_LT((found.row(0) - map.row(0)).norm(), 1e-6);
  EXPECT_LT((found.row(1) - before.row(1)).norm(), 1e-6);
  EXPECT_LT((rotation_of(map * flat, before) - map).norm(), 1e-6);
}

TEST(BoneStretch, ImagesAreColumns) {
  const AxisImages images{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  EXPECT_EQ(matrix_of(images)(2, 0), 3.0);
  EXPECT_EQ(images_of(matrix_of(images)), images);
}

}  // namespace
}  // namespace rlpc
