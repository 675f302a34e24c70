#include "common/codec/kinds/cluster/recon/lcf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace rlpc {
namespace {

__extension__ using Int128 = __int128;

constexpr std::int64_t kOne = std::int64_t{1} << kAxisFractionBits;
constexpr std::int32_t kMaxPosition = (1 << 23) - 1;  // positions of 24 bits
constexpr std::int32_t kMinPosition = -(1 << 23);
constexpr std::int64_t kLocalMost = std::int64_t{1} << 30;

Int128 dot(const Vec3l& a, const Vec3l& b) {
  return Int128{a[0]} * b[0] + Int128{a[1]} * b[1] + Int128{a[2]} * b[2];
}

// Checks that the axes are orthonormal within 2^-26 and right-handed.
void expect_orthonormal(const Lcf& lcf) {
  const Int128 tolerance = Int128{1} << 34;  // 2^60 is 1
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      Int128 error = dot(lcf.axis[i], lcf.axis[j]) - (i == j ? Int128{1} << 60 : 0);
      if (error < 0) error = -error;
      ASSERT_TRUE(error < tolerance) << "axes " << i << " and " << j;
    }
  }
  const Vec3l& x = lcf.axis[0];
  const Vec3l& y = lcf.axis[1];
  const Vec3l cross{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                    x[0] * y[1] - x[1] * y[0]};
  ASSERT_TRUE(dot(cross, lcf.axis[2]) > 0);
}

Vec3i random_position(std::mt19937& random, int bits) {
  Vec3i p{};
  for (std::int32_t& c : p) {
    c = static_cast<std::int32_t>(random() >> 8) % (1 << bits);
    if (random() % 2 == 0) c = -c;
  }
  return p;
}

TEST(Lcf, HasTheFrameOfARightAngle) {
  const Lcf lcf = make_lcf({10, 20, 30}, {14, 20, 30}, {10, 27, 30});
  EXPECT_EQ(lcf.doubled_origin, (Vec3l{24, 40, 60}));
  EXPECT_EQ(lcf.axis[0], (Vec3l{kOne, 0, 0}));
  EXPECT_EQ(lcf.axis[1], (Vec3l{0, kOne, 0}));
  EXPECT_EQ(lcf.axis[2], (Vec3l{0, 0, kOne}));
}

TEST(Lcf, AxesDependOnlyOnTheSideOfTheThirdSeed) {
  // x along -y of the world, the third seed towards +z: normal x cross side is -x.
  const Lcf lcf = make_lcf({0, 0, 0}, {0, -5, 0}, {0, 9, 4});
  EXPECT_EQ(lcf.axis[0], (Vec3l{0, -kOne, 0}));
  EXPECT_EQ(lcf.axis[1], (Vec3l{0, 0, kOne}));
  EXPECT_EQ(lcf.axis[2], (Vec3l{-kOne, 0, 0}));
  const Lcf other = make_lcf({0, 0, 0}, {0, -5, 0}, {0, -100, 4000});
  EXPECT_EQ(other.axis, lcf.axis);
}

TEST(Lcf, AxesAreOrthonormal) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    for (int i = 0; i < 500; ++i) {
      const int bits = 1 + static_cast<int>(random() % 23);
      const Vec3i p1 = random_position(random, bits);
      const Vec3i p2 = random_position(random, bits);
      expect_orthonormal(make_lcf(p1, p2, random_position(random, bits)));
    }
  }
}

// The thinnest and largest triangles of 24-bit positions.
TEST(Lcf, AxesOfExtremeTrianglesAreOrthonormal) {
  const std::vector<std::int32_t> values{kMinPosition,     kMinPosition + 1, -1, 0, 1,
                                         kMaxPosition - 1, kMaxPosition};
  for (const std::int32_t a : values) {
    for (const std::int32_t b : values) {
      for (const std::int32_t c : values) {
        for (const std::int32_t d : values) {
          expect_orthonormal(make_lcf({a, b, c}, {d, a, b}, {b, c, d}));
          expect_orthonormal(make_lcf({a, a, a}, {b, b, c}, {c, c, d}));
        }
      }
    }
  }
}

TEST(Lcf, HasWorldAxesIfTheFirstTwoSeedsCoincide) {
  for (const Vec3i& third :
       {Vec3i{7, -3, 9}, Vec3i{1, 2, 3}, Vec3i{kMaxPosition, kMinPosition, 0}}) {
    const Lcf lcf = make_lcf({1, 2, 3}, {1, 2, 3}, third);
    EXPECT_EQ(lcf.doubled_origin, (Vec3l{2, 4, 6}));
    EXPECT_EQ(lcf.axis[0], (Vec3l{kOne, 0, 0}));
    EXPECT_EQ(lcf.axis[1], (Vec3l{0, kOne, 0}));
    EXPECT_EQ(lcf.axis[2], (Vec3l{0, 0, kOne}));
  }
}

// z = x cross the world axis of the smallest coordinate of x, the first one in a tie.
TEST(Lcf, CollinearSeedsUseADirectionPerpendicularToX) {
  struct Case {
    Vec3i along;
    Vec3l y;
    Vec3l z;
  };
  const std::vector<Case> cases{
      {{1, 0, 0}, {0, kOne, 0}, {0, 0, kOne}},   // smallest: y; x cross y is z
      {{0, 1, 0}, {kOne, 0, 0}, {0, 0, -kOne}},  // smallest: x; y cross x is -z
      {{0, 0, 1}, {kOne, 0, 0}, {0, kOne, 0}},   // smallest: x; z cross x is y
      {{1, 1, 0}, {0, 0, kOne + 1}, {759250125, -759250125, 0}},  // smallest: z
  };
  for (const Case& k : cases) {
    for (const int third : {0, 1, 2, -5}) {
      const Vec3i p1{100, -50, 3};
      Vec3i p2 = p1;
      Vec3i p3 = p1;
      for (std::size_t c = 0; c < 3; ++c) {
        p2[c] += 9 * k.along[c];
        p3[c] += 9 * third * k.along[c];
      }
      const Lcf lcf = make_lcf(p1, p2, p3);
      EXPECT_EQ(lcf.axis[2], k.z);
      expect_orthonormal(lcf);
      EXPECT_EQ(lcf.axis[1], k.y);
    }
  }
}

TEST(Lcf, RandomCollinearSeedsGiveAFrame) {
  constexpr unsigned kSeed = 2;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int i = 0; i < 1000; ++i) {
    const Vec3i p1 = random_position(random, 20);
    const Vec3i along = random_position(random, 19);
    Vec3i p2{};
    Vec3i p3{};
    for (std::size_t c = 0; c < 3; ++c) {
      p2[c] = p1[c] + along[c];
      p3[c] = p1[c] + 3 * along[c];
    }
    if (p1 != p2) expect_orthonormal(make_lcf(p1, p2, p3));
  }
}

TEST(LcfToWorld, TheLocalOriginIsTheMidpointRoundedUp) {
  const Lcf lcf = make_lcf({-3, 7, 0}, {2, 8, 0}, {-3, 9, 5});
  EXPECT_EQ(lcf_to_world(lcf, 0, 0, 0), (Vec3l{0, 8, 0}));  // midpoint (-0.5, 7.5, 0)
}

TEST(LcfToWorld, StepsAlongTheAxes) {
  const Lcf lcf = make_lcf({0, 0, 10}, {0, 0, 30}, {0, 5, 10});  // x is z, y is y, z is -x
  EXPECT_EQ(lcf_to_world(lcf, 16, 0, 0), (Vec3l{0, 0, 21}));
  EXPECT_EQ(lcf_to_world(lcf, 0, 16, 0), (Vec3l{0, 1, 20}));
  EXPECT_EQ(lcf_to_world(lcf, 0, 0, 16), (Vec3l{-1, 0, 20}));
  EXPECT_EQ(lcf_to_world(lcf, 7, -8, -9), (Vec3l{1, 0, 20}));  // below, at and above a half
}

// The sum of 8.4.3 in 128 bits: nothing overflows for the largest frames and coordinates.
TEST(LcfToWorld, IsExactAtItsBounds) {
  for (const std::int32_t p : {kMinPosition, -1, kMaxPosition}) {
    for (const std::int32_t q : {kMinPosition, 0, kMaxPosition}) {
      const Lcf lcf = make_lcf({p, q, p}, {q, q, p}, {q, p, q});
      for (const std::int64_t x : {-kLocalMost, std::int64_t{1}, kLocalMost - 1}) {
        for (const std::int64_t y : {-kLocalMost, std::int64_t{-1}, kLocalMost - 1}) {
          for (const std::int64_t z : {-kLocalMost, std::int64_t{0}, kLocalMost - 1}) {
            const Vec3l world = lcf_to_world(lcf, x, y, z);
            for (std::size_t c = 0; c < 3; ++c) {
              const Int128 sum = (Int128{lcf.doubled_origin[c]} << 33) +
                                 Int128{lcf.axis[0][c]} * x + Int128{lcf.axis[1][c]} * y +
                                 Int128{lcf.axis[2][c]} * z;
              ASSERT_TRUE((sum + (Int128{1} << 33)) >> 34 == world[c]);
            }
          }
        }
      }
    }
  }
}

TEST(LcfToWorld, KeepsDistances) {
  constexpr unsigned kSeed = 3;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int i = 0; i < 1000; ++i) {
    const Vec3i p1 = random_position(random, 22);
    const Vec3i p2 = random_position(random, 22);
    const Lcf lcf = make_lcf(p1, p2, random_position(random, 22));
    const Vec3i a = random_position(random, 20);
    const Vec3l world = lcf_to_world(lcf, 16 * std::int64_t{a[0]}, 16 * std::int64_t{a[1]},
                                     16 * std::int64_t{a[2]});
    double local2 = 0.0;
    double world2 = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d =
          static_cast<double>(world[c]) - 0.5 * static_cast<double>(lcf.doubled_origin[c]);
      world2 += d * d;
      local2 += static_cast<double>(a[c]) * a[c];
    }
    ASSERT_NEAR(std::sqrt(world2), std::sqrt(local2), 1.0);
  }
}

}  // namespace
}  // namespace rlpc
