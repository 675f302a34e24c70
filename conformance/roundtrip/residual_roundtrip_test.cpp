// Tests writer and parser of residuals against each other (clause 9.5).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "common/codec/bits/range_encoder.h"
#include "common/testing/residual_bound.h"
#include "decoder/codec/parse/parse_residual.h"
#include "encoder/codec/write/write_residual.h"

namespace rlpc {
namespace {

using ResidualList =
    std::vector<std::pair<std::uint32_t, std::int32_t>>;  // expected magnitude, value

void expect_residual_round_trip(const ResidualList& list) {
  RangeEncoder re;
  ResidualModels models;
  for (const auto& [expected, value] : list) write_residual(re, models, expected, value);
  const std::vector<std::uint8_t> section = re.finish();
  RangeDecoder rd(section);
  ResidualModels again;
  for (const auto& [expected, value] : list) {
    ASSERT_EQ(parse_residual(rd, again, expected), value) << "expected " << expected;
  }
  EXPECT_TRUE(rd.at_exact_end());
}

// Returns every expected magnitude below 100, and those around all powers of two up to 2^30.
std::vector<std::uint32_t> expected_magnitudes() {
  std::vector<std::uint32_t> list;
  for (std::uint32_t e = 0; e < 100; ++e) list.push_back(e);
  for (int n = 7; n <= 30; ++n) {
    const std::uint32_t power = std::uint32_t{1} << n;
    for (const std::uint32_t e : {power - 1, power, power + power / 16, power + power / 2}) {
      if (e <= std::uint32_t{1} << 30) list.push_back(e);
    }
  }
  return list;
}

// Returns magnitudes around all powers of two, where the escape length changes, and the
// largest.
std::vector<std::int32_t> extreme_values() {
  std::vector<std::int32_t> list{0};
  const auto add = [&](std::int64_t magnitude) {
    if (magnitude <= 0 || magnitude > kResidualBound) return;
    list.push_back(static_cast<std::int32_t>(magnitude));
    list.push_back(-static_cast<std::int32_t>(magnitude));
  };
  for (int m = 1; m < 40; ++m) add(m);
  for (int n = 5; n <= floor_log2(kMaxResidual) + 1; ++n) {
    const std::int64_t power = std::int64_t{1} << n;
    for (const std::int64_t m : {power - 1, power, power + 12, power + 13, power + 14}) add(m);
  }
  return list;
}

TEST(Residual, EveryMagnitudeComesBackInEveryContext) {
  for (const std::uint32_t expected : expected_magnitudes()) {
    ResidualList list;
    for (const std::int32_t value : extreme_values()) list.emplace_back(expected, value);
    expect_residual_round_trip(list);
  }
}

TEST(Residual, TheLargestComesBackAloneInEveryContext) {
  for (const std::uint32_t expected : expected_magnitudes()) {
    expect_residual_round_trip({{expected, kResidualBound}});
    expect_residual_round_trip({{expected, -kResidualBound}});
  }
}

TEST(Residual, RandomValuesComeBack) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    ResidualList list;
    for (int i = 0; i < 2000; ++i) {
      const auto expected = static_cast<std::uint32_t>((random() >> 2) >> (random() % 31));
      // Residuals mostly have the expected magnitude, sometimes any.
      const std::uint64_t around = random() % (expected / 8 + 2);
      const std::uint64_t any = random() >> (4 + random() % 28);
      const auto value = static_cast<std::int32_t>(
          std::min<std::uint64_t>(random() % 16 == 0 ? any : around, kMaxResidual));
      list.emplace_back(expected, random() % 2 == 0 ? value : -value);
    }
    expect_residual_round_trip(list);
  }
}

TEST(Residual, OfAnyBytesIsNoLargerThanTheLargest) {
  std::int32_t largest = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::vector<std::uint8_t> bytes(random() % 60);
    const bool ones = seed % 2 == 0;
    for (std::uint8_t& b : bytes)
      b = static_cast<std::uint8_t>(ones ? random() | 0xFC : random());
    RangeDecoder rd(bytes);
    ResidualModels models;
    for (const std::uint32_t expected : expected_magnitudes()) {
      const std::int32_t value = parse_residual(rd, models, expected);
      ASSERT_LE(value, kResidualBound);
      ASSERT_GE(value, -kResidualBound);
      largest = std::max(largest, value < 0 ? -value : value);
    }
  }
  EXPECT_EQ(largest, kResidualBound);  // clipping did happen
}

TEST(ResidualContext, GrowsWithTheExpectedMagnitude) {
  int before = -1;
  for (const std::uint32_t e : expected_magnitudes()) {
    const ResidualContext ctx = residual_context(e);
    ASSERT_GE(ctx.index, 0);
    ASSERT_LT(ctx.index, kResidualContexts);
    EXPECT_EQ(ctx.shift > 0, ctx.index >= 7);
    const int order = ctx.shift == 0 ? ctx.index : 7 + 2 * (ctx.shift - 1) + (ctx.index - 7);
    ASSERT_GE(order, before) << e;
    before = order;
  }
  EXPECT_EQ(residual_context(std::uint32_t{1} << 30).shift, 25);
}

TEST(ResidualContext, OfSmallMagnitudesIsThatOfTheTable) {
  for (std::uint32_t e = 0; e < 48; ++e) {
    int index = 0;
    for (const std::uint32_t first : {2U, 4U, 8U, 14U, 22U, 32U}) {
      if (e >= first) ++index;
    }
    EXPECT_EQ(residual_context(e).index, index) << e;
  }
}

TEST(UpdateMean, MovesTowardsTheMagnitudeAndNotPastIt) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uint32_t mean = 0;
    for (int i = 0; i < 2000; ++i) {
      const int rate = 1 + static_cast<int>(random() % 4);
      const auto magnitude = static_cast<std::uint32_t>((random() >> 5) >> (random() % 27));
      const std::uint32_t target = std::min<std::uint32_t>(magnitude, 1U << 20) << 8;
      const std::uint32_t next = update_mean(mean, magnitude, rate);
      ASSERT_LE(next, std::max(mean, target));
      ASSERT_GE(next, std::min(mean, target));
      ASSERT_LE(next, 1U << 28);
      mean = next;
    }
  }
}

TEST(UpdateMean, OfOneMagnitudeConvergesToIt) {
  for (const int rate : {1, 2, 3, 4}) {
    std::uint32_t mean = 0;
    for (int i = 0; i < 1000; ++i) mean = update_mean(mean, 77, rate);
    EXPECT_NEAR(mean, 77 * 256, 16);
    for (int i = 0; i < 1000; ++i) mean = update_mean(mean, 3, rate);
    EXPECT_NEAR(mean, 3 * 256, 16);
  }
}

}  // namespace
}  // namespace rlpc
