#include "encoder/codec/math/det_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace rlpc {
namespace {

TEST(DetLog2, IsExactAtPowersOfTwo) {
  for (int n = -1074; n <= 1023; ++n) {
    ASSERT_EQ(det_log2(std::ldexp(1.0, n)), n);
  }
}

TEST(DetLog2, AgreesWithTheLibraryWithinItsError) {
  constexpr unsigned kSeed = 1;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 100000; ++i) {
    const double mantissa = 1.0 + static_cast<double>(random() >> 11) * 0x1p-53;
    const double x = std::ldexp(mantissa, static_cast<int>(random() % 2096) - 1074);
    if (!(x > 0.0) || std::isinf(x)) continue;
    ASSERT_NEAR(det_log2(x), std::log2(x), 1e-9) << x;
  }
}

TEST(DetLog2, IsAccurateAtItsLimitsAndSeams) {
  const double root = std::sqrt(2.0);
  for (const double x :
       {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::min(),
        std::nextafter(std::numeric_limits<double>::min(), 0.0),
        std::numeric_limits<double>::max(), root, std::nextafter(root, 0.0),
        std::nextafter(root, 2.0), std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0),
        std::nextafter(2.0, 0.0)}) {
    EXPECT_NEAR(det_log2(x), std::log2(x), 1e-9) << x;
  }
}

TEST(DetLog2, KeepsItsRelativeErrorNearOne) {
  for (int n = 2; n < 40; ++n) {
    for (const double x : {1.0 + std::ldexp(1.0, -n), 1.0 - std::ldexp(1.0, -n)}) {
      EXPECT_NEAR(det_log2(x) / std::log2(x), 1.0, 1e-9) << x;
    }
  }
}

TEST(ExactExp2, IsThePowerOfTwo) {
  for (int n = -999; n < 1000; ++n) ASSERT_EQ(exact_exp2(n), std::ldexp(1.0, n));
}

TEST(DetSin, AgreesWithTheLibrary) {
  for (int i = -1000; i <= 1000; ++i) {
    const double x = i * (1.5707963267948966 / 1000);
    ASSERT_NEAR(det_sin(x), std::sin(x), 1e-15) << x;
  }
  EXPECT_EQ(det_sin(1e-300), 1e-300);
}

TEST(DetAtan, AgreesWithTheLibrary) {
  for (int i = 0; i <= 1000; ++i) {
    const double x = i / 1000.0;
    ASSERT_NEAR(det_atan(x), std::atan(x), 1e-15) << x;
  }
  EXPECT_EQ(det_atan(1e-300), 1e-300);
}

TEST(RoundToInt, TiesGoAwayFromZero) {
  EXPECT_EQ(round_to_int(0.0), 0);
  EXPECT_EQ(round_to_int(0.5), 1);
  EXPECT_EQ(round_to_int(-0.5), -1);
  EXPECT_EQ(round_to_int(2.5), 3);
  EXPECT_EQ(round_to_int(-2.5), -3);
  EXPECT_EQ(round_to_int(2.4375), 2);
  EXPECT_EQ(round_to_int(-2.4375), -2);
  EXPECT_EQ(round_to_int(0x1p51 + 1.0), (std::int64_t{1} << 51) + 1);
  EXPECT_EQ(round_to_int(-0x1p51 - 1.0), -(std::int64_t{1} << 51) - 1);
}

}  // namespace
}  // namespace rlpc
