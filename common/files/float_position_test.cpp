#include "common/files/float_position.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rlpc {
namespace {

constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();

float value(std::int32_t log2_step, std::int32_t origin, std::int32_t position) {
  return float_position({log2_step, {0, origin, 0}}, 1, position);
}

TEST(FloatPosition, AddsTheOriginOfItsAxis) {
  const Grid grid{-2, {100, 0, -100}};
  EXPECT_EQ(float_position(grid, 0, 3), 25.75F);
  EXPECT_EQ(float_position(grid, 1, 3), 0.75F);
  EXPECT_EQ(float_position(grid, 2, 3), -24.25F);
  EXPECT_EQ(value(0, kMax, kMax), 0x1p32F);  // the sum takes 33 bits
  EXPECT_EQ(value(0, kMin, kMin), -0x1p32F);
}

// 7.3: to nearest, ties to even.
TEST(FloatPosition, RoundsOnce) {
  EXPECT_EQ(value(0, 0, 16777217), 0x1p24F);
  EXPECT_EQ(value(0, 0, 16777219), 0x1.000004p24F);
  EXPECT_EQ(value(0, 16777216, 1), 0x1p24F);
  EXPECT_EQ(value(-150, 0, 1), 0.0F);
  EXPECT_EQ(value(-150, 0, 3), 0x1p-148F);
  EXPECT_EQ(value(-150, 0, -5), -0x1p-148F);
  EXPECT_EQ(value(120, 0, 1), 0x1p120F);
}

TEST(FloatPosition, IsTheExactProductForEveryStep) {
  std::uint64_t state = 1;
  for (std::int32_t log2_step = -150; log2_step <= 120; ++log2_step) {
    for (int i = 0; i < 2000; ++i) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      const auto position =
          static_cast<std::int32_t>(state >> 32) >> static_cast<int>((state >> 27) % 31);
      const auto origin = static_cast<std::int32_t>(state >> 7) >> static_cast<int>(state % 31);
      const double steps = static_cast<double>(position) + static_cast<double>(origin);
      const auto expected = static_cast<float>(std::ldexp(steps, log2_step));
      ASSERT_EQ(std::bit_cast<std::uint32_t>(value(log2_step, origin, position)),
                std::bit_cast<std::uint32_t>(expected))
          << position << " + " << origin << ", step 2^" << log2_step;
    }
  }
}

}  // namespace
}  // namespace rlpc
