#include "common/codec/bits/int_math.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace rlpc {
namespace {

__extension__ using Int128 = __int128;

// floor(a / b) for b > 0, by the definition: the largest q with q * b <= a.
Int128 floor_div(Int128 a, Int128 b) {
  Int128 q = a / b;
  while (q * b > a) --q;
  while ((q + 1) * b <= a) ++q;
  return q;
}

TEST(Round2, IsTheFloorOfTheDefinitionOnASmallRange) {
  for (std::int64_t x = -300; x <= 300; ++x) {
    EXPECT_EQ(round2(x, 0), x);
    for (int n = 1; n < 12; ++n) {
      const Int128 half = Int128{1} << (n - 1);
      EXPECT_TRUE(floor_div(x + half, Int128{1} << n) == round2(x, n)) << x << " " << n;
    }
  }
}

TEST(Round2, TiesGoUp) {
  EXPECT_EQ(round2(3, 1), 2);
  EXPECT_EQ(round2(-3, 1), -1);
  EXPECT_EQ(round2(6, 2), 2);
  EXPECT_EQ(round2(-6, 2), -1);
  EXPECT_EQ(round2(-(std::int64_t{1} << 40), 41), 0);
  EXPECT_EQ(round2(-(std::int64_t{1} << 40) - 1, 41), -1);
}

TEST(Round2, TakesTheLargestArguments) {
  const std::int64_t max = (std::int64_t{1} << 62) - 1;
  EXPECT_EQ(round2(max, 0), max);
  EXPECT_EQ(round2(max, 61), 2);
  EXPECT_EQ(round2(-max, 61), -2);
  EXPECT_EQ(round2(max, 30), std::int64_t{1} << 32);
}

TEST(DivRound, IsTheFloorOfTheDefinitionOnASmallRange) {
  for (std::int64_t x = -200; x <= 200; ++x) {
    for (std::int64_t n = 1; n <= 40; ++n) {
      EXPECT_TRUE(floor_div(2 * x + n, 2 * n) == div_round(x, n)) << x << " " << n;
    }
  }
}

TEST(DivRound, IsTheFloorOfTheDefinitionOnRandomLargeArguments) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 20000; ++i) {
    const auto x = static_cast<std::int64_t>(random()) >> (2 + random() % 60);
    const auto n =
        static_cast<std::int64_t>((random() >> (3 + random() % 60)) | 1);  // 1 .. 2^61 - 1
    const Int128 expected = floor_div(Int128{2} * x + n, Int128{2} * n);
    ASSERT_TRUE(expected == div_round(x, n)) << x << " / " << n;
  }
}

TEST(DivRound, AgreesWithRound2OnPowersOfTwo) {
  for (std::int64_t x = -100; x <= 100; ++x) {
    for (int n = 0; n < 10; ++n) EXPECT_EQ(div_round(x, std::int64_t{1} << n), round2(x, n));
  }
}

TEST(Clip3, KeepsWhatIsInsideAndReturnsTheNearerEndElsewhere) {
  for (std::int64_t x = -5; x <= 12; ++x) {
    EXPECT_EQ(clip3(-3, 9, x), x < -3 ? -3 : x > 9 ? 9 : x);
  }
  EXPECT_EQ(clip3(4, 4, -1), 4);
}

TEST(ClipSigned, HasTheRangeOfTwosComplement) {
  for (int bits = 1; bits <= 32; ++bits) {
    const std::int64_t half = std::int64_t{1} << (bits - 1);
    EXPECT_EQ(clip_signed(bits, half), half - 1);
    EXPECT_EQ(clip_signed(bits, half - 1), half - 1);
    EXPECT_EQ(clip_signed(bits, -half), -half);
    EXPECT_EQ(clip_signed(bits, -half - 1), -half);
    EXPECT_EQ(clip_signed(bits, std::numeric_limits<std::int64_t>::min()), -half);
    EXPECT_EQ(clip_signed(bits, std::numeric_limits<std::int64_t>::max()), half - 1);
    EXPECT_EQ(clip_signed(bits, 0), 0);
  }
}

TEST(Logarithms, AreThoseOfRepeatedHalving) {
  for (std::uint64_t x = 1; x < 5000; ++x) {
    int floor = 0;
    while ((x >> floor) > 1) ++floor;
    int ceil = 0;
    while ((std::uint64_t{1} << ceil) < x) ++ceil;
    EXPECT_EQ(floor_log2(x), floor) << x;
    EXPECT_EQ(ceil_log2(x), ceil) << x;
  }
}

TEST(Logarithms, ChangeExactlyAtPowersOfTwo) {
  for (int n = 2; n < 64; ++n) {
    const std::uint64_t power = std::uint64_t{1} << n;
    EXPECT_EQ(floor_log2(power), n);
    EXPECT_EQ(floor_log2(power - 1), n - 1);
    EXPECT_EQ(ceil_log2(power), n);
    EXPECT_EQ(ceil_log2(power - 1), n);
    EXPECT_EQ(ceil_log2(power + 1), n + 1);
  }
  EXPECT_EQ(floor_log2(~std::uint64_t{0}), 63);
}

void expect_floor_of_root(std::int64_t x) {
  const Int128 root = isqrt(x);
  ASSERT_TRUE(root >= 0 && root * root <= x && (root + 1) * (root + 1) > x) << x;
}

TEST(ISqrt, IsTheFloorOfTheRoot) {
  for (std::int64_t x = 0; x < 20000; ++x) expect_floor_of_root(x);
  constexpr unsigned kSeed = 12;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 20000; ++i) {
    expect_floor_of_root(static_cast<std::int64_t>(random() >> (2 + random() % 62)));
  }
}

TEST(ISqrt, ChangesExactlyAtSquares) {
  for (const std::int64_t root :
       {std::int64_t{1}, std::int64_t{46341}, std::int64_t{0x3FFFFFFF}, (std::int64_t{1} << 30),
        (std::int64_t{1} << 31) - 1}) {
    EXPECT_EQ(isqrt(root * root), root);
    EXPECT_EQ(isqrt(root * root - 1), root - 1);
  }
  EXPECT_EQ(isqrt((std::int64_t{1} << 62) - 1), (std::int64_t{1} << 31) - 1);
}

constexpr std::int64_t kOne = std::int64_t{1} << 30;

// The squared length lies between those of vectors 2^-28 shorter and longer than 1.
void expect_unit_length(const Vec3l& v) {
  const Vec3l u = normalize3(v);
  Int128 squares = 0;
  for (const std::int64_t c : u) squares += Int128{c} * c;
  const Int128 shortest = kOne - 4;
  const Int128 longest = kOne + 4;
  ASSERT_TRUE(squares > shortest * shortest && squares < longest * longest)
      << v[0] << " " << v[1] << " " << v[2];
}

// |u x v| is small against |v|: both point the same way.
void expect_same_direction(const Vec3l& v) {
  const Vec3l u = normalize3(v);
  Int128 dot = 0;
  std::int64_t largest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    dot += Int128{u[c]} * v[c];
    largest = std::max(largest, v[c] < 0 ? -v[c] : v[c]);
  }
  ASSERT_TRUE(dot > 0);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t d = (c + 1) % 3;
    Int128 cross = Int128{u[c]} * v[d] - Int128{u[d]} * v[c];
    if (cross < 0) cross = -cross;
    ASSERT_TRUE(cross <= Int128{8} * largest) << v[0] << " " << v[1] << " " << v[2];
  }
}

std::vector<Vec3l> random_vectors(unsigned seed, int max_bits, int count) {
  std::mt19937_64 random(seed);
  std::vector<Vec3l> vectors;
  while (static_cast<int>(vectors.size()) < count) {
    Vec3l v{};
    const int bits = 1 + static_cast<int>(random() % static_cast<unsigned>(max_bits));
    for (std::int64_t& c : v) {
      const int own = static_cast<int>(random() % static_cast<unsigned>(bits + 1));
      c = static_cast<std::int64_t>(random() & ((std::uint64_t{1} << own) - 1));
      if (random() % 2 == 0) c = -c;
    }
    if (v != Vec3l{0, 0, 0}) vectors.push_back(v);
  }
  return vectors;
}

TEST(Normalize3, GivesUnitVectorsOfTheSameDirection) {
  constexpr unsigned kSeed = 13;
  SCOPED_TRACE(kSeed);
  for (const Vec3l& v : random_vectors(kSeed, 56, 20000)) {
    expect_unit_length(v);
    expect_same_direction(v);
  }
}

TEST(Normalize3, TakesTinyAndHugeVectors) {
  const std::int64_t huge = (std::int64_t{1} << 56) - 1;
  for (const std::int64_t a :
       {-huge, std::int64_t{-1}, std::int64_t{0}, std::int64_t{1}, huge}) {
    for (const std::int64_t b : {-huge, std::int64_t{0}, std::int64_t{1}, huge}) {
      for (const std::int64_t c : {std::int64_t{-1}, std::int64_t{1}, huge}) {
        expect_unit_length({a, b, c});
        expect_same_direction({a, b, c});
      }
    }
  }
}

TEST(Normalize3, IsExactAlongTheAxesAndZeroForZero) {
  EXPECT_EQ(normalize3({0, 0, 0}), (Vec3l{0, 0, 0}));
  for (int bits = 0; bits <= 56; ++bits) {
    const std::int64_t length = (std::int64_t{1} << bits) - (bits == 56 ? 1 : 0);
    EXPECT_EQ(normalize3({length, 0, 0}), (Vec3l{kOne, 0, 0}));
    EXPECT_EQ(normalize3({0, -length, 0}), (Vec3l{0, -kOne, 0}));
    EXPECT_EQ(normalize3({0, 0, length}), (Vec3l{0, 0, kOne}));
  }
}

TEST(Normalize3, FindsAThreeFourFiveTriangle) {
  // 3 * 2^28 and 4 * 2^27 ... after scaling to 30 bits the norm is 5 * 2^27 exactly.
  const std::int64_t fifth = kOne / 5;  // 2^30 / 5 rounded down; 4/5 and 3/5 round from it
  const Vec3l u = normalize3({3, 0, -4});
  EXPECT_EQ(u[0], div_round(3 * kOne, 5));
  EXPECT_EQ(u[1], 0);
  EXPECT_EQ(u[2], div_round(-4 * kOne, 5));
  EXPECT_LT(u[0] - 3 * fifth, 3);
}

TEST(Normalize3, DoesNotChangeWithScalingByPowersOfTwo) {
  constexpr unsigned kSeed = 14;
  SCOPED_TRACE(kSeed);
  for (const Vec3l& v : random_vectors(kSeed, 20, 500)) {
    for (const int shift : {1, 7, 36}) {
      Vec3l scaled = v;
      for (std::int64_t& c : scaled) c *= std::int64_t{1} << shift;
      EXPECT_EQ(normalize3(scaled), normalize3(v));
    }
  }
}

TEST(Normalize3, TreatsItsCoordinatesAlike) {
  constexpr unsigned kSeed = 15;
  SCOPED_TRACE(kSeed);
  for (const Vec3l& v : random_vectors(kSeed, 56, 500)) {
    const Vec3l u = normalize3(v);
    EXPECT_EQ(normalize3({v[1], v[2], v[0]}), (Vec3l{u[1], u[2], u[0]}));
    EXPECT_EQ(normalize3({v[1], v[0], v[2]}), (Vec3l{u[1], u[0], u[2]}));
  }
}

// Up to 30 bits, only the last rounding sees the sign, and only in a tie, which goes up.
TEST(Normalize3, OfTheNegatedVectorIsNegatedButForTies) {
  constexpr unsigned kSeed = 16;
  SCOPED_TRACE(kSeed);
  for (const Vec3l& v : random_vectors(kSeed, 30, 5000)) {
    const Vec3l u = normalize3(v);
    const Vec3l w = normalize3({-v[0], -v[1], -v[2]});
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GE(u[c] + w[c], 0);
      EXPECT_LE(u[c] + w[c], 1);
    }
  }
}

}  // namespace
}  // namespace rlpc
