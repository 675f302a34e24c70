#include "common/codec/kinds/skinned/recon/quaternion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "common/testing/real_quaternions.h"

namespace rlpc {
namespace {

TEST(Quaternions, ZeroIsNormalisedToNoRotation) {
  EXPECT_EQ(normalize_quaternion({0, 0, 0, 0}), kNoRotation);
}

TEST(Quaternions, OnAnAxisAreExact) {
  for (const std::int64_t x :
       {std::int64_t{1}, std::int64_t{12345}, (std::int64_t{1} << 56) - 1}) {
    EXPECT_EQ(normalize_quaternion({x, 0, 0, 0}), kNoRotation) << x;
    EXPECT_EQ(normalize_quaternion({0, 0, -x, 0}), (Quaternion{0, 0, -kOneI, 0})) << x;
  }
}

// The bounds of 8.12.4, for coordinates of every width up to 56 bits.
TEST(Quaternions, AreOfUnitLengthAndKeepTheirDirection) {
  RandomRotations random(1);
  for (int bits = 1; bits <= 56; ++bits) {
    for (int i = 0; i < 300; ++i) {
      Quaternion q = random.quaternion(bits);
      if (i % 3 == 0) q[random.below(4)] = (std::int64_t{1} << bits) - 1;
      if (i % 5 == 0) q[random.below(4)] = -(std::int64_t{1} << bits) + 1;
      const Quaternion u = normalize_quaternion(q);
      ASSERT_LT(length_of(u), kQuaternionOne + 8.0) << bits;
      ASSERT_GT(length_of(u), kQuaternionOne - 8.0) << bits;
      if (q == Quaternion{}) continue;
      const Real4 exact = unit(q);
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_LE(std::abs(u[c]), kOneI);
        // Scaling to 29 bits causes an error of 1/2 per coordinate: 2 here, and 4 in the norm.
        ASSERT_NEAR(static_cast<double>(u[c]), exact[c] * kQuaternionOne, 8.0) << bits;
      }
    }
  }
}

TEST(Quaternions, ProductsAreHamiltonProducts) {
  RandomRotations random(2);
  for (int i = 0; i < 20000; ++i) {
    const Quaternion p = random.rotation();
    const Quaternion q = i % 2 == 0 ? random.rotation() : random.quaternion(30);
    Quaternion corner{kOneI, kOneI - 1, -kOneI, kOneI - 1};  // the maximum length
    if (i % 7 == 0) std::rotate(corner.begin(), corner.begin() + i % 4, corner.end());
    const Quaternion& second = i % 7 == 0 ? corner : q;
    if (length_of(second) < kQuaternionOne / 16)
      continue;  // too short to have a precise direction
    const Quaternion r = rotation_after(p, second);
    const Real4 exact = times(unit(p), unit(second));
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_NEAR(static_cast<double>(r[c]), exact[c] * kQuaternionOne, 32.0) << i;
    }
  }
}

// Bit-exact results of the pseudo-code of 8.12.4.
TEST(Quaternions, AgreeWithThePseudoCode) {
  const Quaternion p = normalize_quaternion({3, -1, 2, 5});
  const Quaternion q = normalize_quaternion({7, 1, -1, 1});
  EXPECT_EQ(p, (Quaternion{515808888, -171936296, 343872592, 859681480}));
  EXPECT_EQ(normalize_quaternion({-123456789012345, 98765432109876, 5, -1}),
            (Quaternion{-838451497, 670761205, 0, 0}));
  EXPECT_EQ(
      normalize_quaternion({72057594037927935, -36028797018963965, 18014398509481991, -12345}),
      (Quaternion{937238702, -468619351, 234309676, 0}));
  EXPECT_EQ(rotation_after(p, q), (Quaternion{453022211, 71529822, 405335663, 882201148}));
  EXPECT_EQ(rotation_after(q, p), (Quaternion{453022212, -262276016, 119216372, 929887698}));
  EXPECT_EQ(rotation_after(p, {kOneI, 1 << 20, -kOneI, 12345}),
            (Quaternion{607998198, 486668146, -120982254, 729230488}));
  EXPECT_EQ(axes_of(p), (std::array<Vec3l, 3>{{{-523104992, 715827883, -605700517},
                                               {-936082616, -357913942, 385445783},
                                               {55063683, 715827883, 798423407}}}));
}

TEST(Quaternions, NoRotationIsNeutral) {
  EXPECT_EQ(rotation_after(kNoRotation, kNoRotation), kNoRotation);
  RandomRotations random(3);
  for (int i = 0; i < 1000; ++i) {
    const Quaternion q = random.rotation();
    for (const Quaternion& r :
         {rotation_after(kNoRotation, q), rotation_after(q, kNoRotation)}) {
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_NEAR(static_cast<double>(r[c]), static_cast<double>(q[c]), 8.0);
      }
    }
  }
}

TEST(Axes, AreExactForNoRotationAndQuarterTurns) {
  EXPECT_EQ(axes_of(kNoRotation),
            (std::array<Vec3l, 3>{{{kOneI, 0, 0}, {0, kOneI, 0}, {0, 0, kOneI}}}));
  const Quaternion about_z = normalize_quaternion({1 << 20, 0, 0, 1 << 20});
  const auto axes = axes_of(about_z);
  const std::array<Vec3l, 3> exact{{{0, kOneI, 0}, {-kOneI, 0, 0}, {0, 0, kOneI}}};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_LE(std::abs(axes[k][c] - exact[k][c]), 4) << k << c;
  }
}

TEST(Axes, AreTheRotatedAxes) {
  RandomRotations random(4);
  for (int i = 0; i < 5000; ++i) {
    const Quaternion q = random.rotation();
    const auto axes = axes_of(q);
    for (std::size_t k = 0; k < 3; ++k) {
      Real3 axis{};
      axis[k] = 1.0;
      const Real3 exact = turned(unit(q), axis);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(static_cast<double>(axes[k][c]), exact[c] * kQuaternionOne, 24.0);
        ASSERT_LE(std::abs(axes[k][c]), kOneI + 16) << "the bound of 8.12.3";
      }
    }
  }
}

}  // namespace
}  // namespace rlpc
