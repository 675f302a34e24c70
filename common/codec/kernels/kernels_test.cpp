// Compares all kernels that the machine supports with the text of the specification.
#include "common/codec/kernels/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/skinned/recon/bones.h"

namespace rlpc {
namespace {

// Returns numbers of random width, often at the extremes.
std::int64_t random_within(std::mt19937_64& random, std::int64_t min, std::int64_t max) {
  switch (random() % 8) {
    case 0:
      return min;
    case 1:
      return max;
    case 2:
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(random() % 5) - 2, min, max);
    default:
      return min +
             static_cast<std::int64_t>(random() % (static_cast<std::uint64_t>(max - min) + 1));
  }
}

std::vector<std::int32_t> random_list(std::mt19937_64& random, std::size_t n, std::int64_t min,
                                      std::int64_t max) {
  std::vector<std::int32_t> list(n);
  for (std::int32_t& x : list) x = static_cast<std::int32_t>(random_within(random, min, max));
  return list;
}

class EachTileLoop : public testing::TestWithParam<std::size_t> {
 protected:
  const Kernels& loops() const { return kernels()[GetParam()]; }
};

TEST_P(EachTileLoop, SumsProductsOfAnyRowsAndPairs) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto num_pairs = static_cast<std::size_t>(1 + random() % 8);
    const auto rows = static_cast<std::size_t>(1 + random() % 9);
    const auto first = static_cast<std::size_t>(random() % 3);
    // 16 products with a sum within 31 bits, or one with both factors at their extremes.
    const std::int64_t s_most = seed % 2 == 0 ? (1 << 13) : (1 << 15);
    const std::int64_t t_most = seed % 2 == 0 ? (1 << 14) : (1 << 15);
    std::vector<std::int16_t> temporal(2 * num_pairs * (first + rows + 1));
    std::vector<std::int16_t> spatial(2 * num_pairs * kTileValues);
    const std::size_t max_used = seed % 2 == 0 ? 16 : 1;
    for (std::size_t j = 0; j < std::min(max_used, 2 * num_pairs); ++j) {
      const auto fill = [&](std::vector<std::int16_t>& list, std::size_t n, std::int64_t max) {
        for (std::size_t i = 0; i < n; ++i) {
          list[2 * (j / 2 * n + i) + j % 2] =
              static_cast<std::int16_t>(random_within(random, -max, max - 1));
        }
      };
      fill(temporal, first + rows + 1, t_most);
      fill(spatial, kTileValues, s_most);
    }
    const FactorPairs factors{temporal.data(), first + rows + 1, spatial.data(), num_pairs};
    std::vector<std::int32_t> sums(rows * kTileValues, 12345);
    loops().sum_products(factors, first, rows, sums.data());
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t i = 0; i < kTileValues; ++i) {
        std::int64_t sum = 0;
        for (std::size_t j = 0; j < 2 * num_pairs; ++j) {
          sum += std::int64_t{temporal[2 * (j / 2 * (first + rows + 1) + first + r) + j % 2]} *
                 spatial[2 * (j / 2 * kTileValues + i) + j % 2];
        }
        ASSERT_EQ(sums[r * kTileValues + i], sum) << "row " << r << ", value " << i;
      }
    }
  }
}

TEST_P(EachTileLoop, AddsWeightedValuesOfAnyNumber) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto n = static_cast<std::size_t>(random() % 20);
    const auto values = random_list(random, n, INT32_MIN, INT32_MAX);
    const auto weight =
        static_cast<std::int32_t>(random_within(random, -(1 << 26), std::int64_t{1} << 26));
    std::vector<std::int64_t> sums(n + 4, -7);
    loops().add_weighted(values.data(), weight, n, sums.data());
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(sums[i], std::int64_t{weight} * values[i] - 7) << i;
    }
    EXPECT_EQ(sums[n], -7);
  }
}

TEST_P(EachTileLoop, MovesPointsAsBonesDo) {
  constexpr std::int64_t kAxis = (std::int64_t{1} << 30) + 16;
  constexpr std::int64_t kArm = std::int64_t{1} << 29;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const std::size_t n = 1 + random() % kTileValues;
    std::array<std::vector<std::int32_t>, 3> arm;
    for (auto& list : arm) list = random_list(random, n + 3, -kArm, kArm);
    const auto weight = random_list(random, n + 3, 1, 128);
    BonePose pose;
    for (Vec3l& axis : pose.axes) {
      for (std::int64_t& x : axis) x = random_within(random, -kAxis, kAxis);
    }
    for (std::int64_t& x : pose.origin) x = random_within(random, -(1 << 30), (1 << 30) - 1);
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<std::int32_t, 3> axis{};
      for (std::size_t k = 0; k < 3; ++k) axis[k] = static_cast<std::int32_t>(pose.axes[k][c]);
      std::vector<std::int64_t> places(kTileValues);
      loops().weighted_places({{arm[0].data(), arm[1].data(), arm[2].data()}, weight.data(), n},
                              axis, static_cast<std::int32_t>(pose.origin[c]), places.data());
      for (std::size_t i = 0; i < n; ++i) {
        const Vec3l moved = moved_point(pose, {}, {arm[0][i], arm[1][i], arm[2][i]});
        ASSERT_EQ(places[i], weight[i] * moved[c]) << i;
      }
    }
  }
}

TEST_P(EachTileLoop, RoundsAndClipsPositions) {
  constexpr std::int64_t kSum = std::int64_t{1} << 58;
  for (unsigned seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const PositionWidths widths{static_cast<int>(random() % 8), static_cast<int>(random() % 25),
                                2 + static_cast<int>(random() % 23)};
    std::vector<std::int64_t> places(kTileValues);
    std::vector<std::int64_t> displacements(kTileValues);
    // Sums close to the clipping limits, and any others.
    const std::int64_t moved = std::int64_t{3} << (29 + widths.fraction_bits);
    for (std::int64_t& x : displacements) {
      const std::int64_t max = random() % 2 == 0 ? moved : kSum;
      x = random_within(random, -max, max);
    }
    const std::int64_t place = std::int64_t{5} << (29 + widths.weight_bits);
    for (std::int64_t& x : places) x = random_within(random, -place, place);
    std::vector<std::int32_t> positions(kTileValues);
    loops().positions(places.data(), displacements.data(), widths, positions.data());
    for (std::size_t i = 0; i < kTileValues; ++i) {
      const std::int64_t sum = round2(places[i], widths.weight_bits) +
                               clip_signed(31, round2(displacements[i], widths.fraction_bits));
      ASSERT_EQ(positions[i], clip_signed(widths.position_bits, round2(sum, 4))) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheMachine, EachTileLoop,
                         testing::Range<std::size_t>(0, kernels().size()));

}  // namespace
}  // namespace rlpc
