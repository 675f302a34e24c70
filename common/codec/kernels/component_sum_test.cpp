#include "common/codec/kernels/component_sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace rlpc {
namespace {

__extension__ using Int128 = __int128;

struct Factor {
  std::vector<std::int32_t> temporal;  // [num_frames]
  std::vector<std::int32_t> spatial;   // [num_values]
  int temporal_bits = 1;
  int spatial_bits = 1;
};

// Plain twin of ComponentSum: 8.5.3 literally, in 128 bits.
std::vector<Int128> plain_sum(const std::vector<Factor>& factors, std::size_t num_values,
                              std::size_t frame) {
  std::vector<Int128> sums(num_values, 0);
  for (const Factor& f : factors) {
    const int shift = f.spatial_bits < 13 ? 13 - f.spatial_bits : 0;
    for (std::size_t i = 0; i < num_values; ++i) {
      sums[i] += Int128{f.temporal[frame]} * (Int128{f.spatial[i]} * (1 << shift));
    }
  }
  return sums;
}

ComponentSum sum_of(const std::vector<Factor>& factors, std::size_t num_values,
                    std::size_t num_frames, const Kernels& loops = kernels().back()) {
  const auto spatial = std::make_shared<SpatialFactors>(num_values);
  std::vector<TemporalFactor> temporal;
  for (const Factor& f : factors) {
    spatial->add(f.spatial, f.spatial_bits);
    temporal.push_back({f.temporal, f.temporal_bits});
  }
  return {spatial, temporal, num_frames, loops};
}

// Returns all values of a row.
std::vector<std::int64_t> sums_of(const ComponentSum& set, std::size_t row) {
  std::vector<std::int64_t> sums;
  for (std::size_t tile = 0; sums.size() < set.num_values(); ++tile) {
    std::vector<std::int64_t> tile_sums(kTileValues);
    set.add_tile(tile, row, 1, tile_sums);
    sums.insert(sums.end(), tile_sums.begin(), tile_sums.end());
  }
  sums.resize(set.num_values());
  return sums;
}

void expect_sums_of_the_plain_twin(const std::vector<Factor>& factors, std::size_t num_values,
                                   std::size_t num_frames) {
  for (const Kernels& loops : kernels()) {
    const ComponentSum set = sum_of(factors, num_values, num_frames, loops);
    for (std::size_t frame = 0; frame < num_frames; ++frame) {
      const std::vector<std::int64_t> sums = sums_of(set, frame);
      const std::vector<Int128> plain = plain_sum(factors, num_values, frame);
      for (std::size_t i = 0; i < num_values; ++i) {
        ASSERT_TRUE(plain[i] == sums[i]) << "frame " << frame << ", value " << i;
      }
    }
  }
}

std::int32_t random_signed(std::mt19937& random, int bits) {
  const auto span = std::uint64_t{1} << bits;
  return static_cast<std::int32_t>(static_cast<std::int64_t>(random() % span) -
                                   static_cast<std::int64_t>(span / 2));
}

struct Widths {
  int min_spatial, max_spatial, min_temporal, max_temporal;
};

std::vector<Factor> random_factors(std::mt19937& random, const Widths& w, std::size_t count,
                                   std::size_t num_values, std::size_t num_frames) {
  const auto between = [&](int min, int max) {
    return min + static_cast<int>(random() % static_cast<unsigned>(max - min + 1));
  };
  std::vector<Factor> factors(count);
  for (Factor& f : factors) {
    f.spatial_bits = between(w.min_spatial, w.max_spatial);
    f.temporal_bits = between(w.min_temporal, w.max_temporal);
    for (std::size_t i = 0; i < num_values; ++i) {
      f.spatial.push_back(random_signed(random, f.spatial_bits));
    }
    for (std::size_t i = 0; i < num_frames; ++i) {
      f.temporal.push_back(random_signed(random, f.temporal_bits));
    }
  }
  return factors;
}

// Narrow factors, a lone limb, and two limbs; over the edge of a tile.
TEST(SpatialFactors, TilesHaveTheNormalisedFactors) {
  constexpr std::size_t kValues = kTileValues + 3;
  const std::vector<int> bits{5, 16, 13, 24};
  SpatialFactors factors(kValues);
  const auto value = [&](std::size_t component, std::size_t i) {
    const std::size_t limit = std::size_t{1} << (bits[component] - 1);
    return static_cast<std::int32_t>((i * 7919 + component) % (2 * limit)) -
           static_cast<std::int32_t>(limit);
  };
  for (std::size_t k = 0; k < bits.size(); ++k) {
    std::vector<std::int32_t> spatial;
    for (std::size_t i = 0; i < kValues; ++i) spatial.push_back(value(k, i));
    factors.add(spatial, bits[k]);
  }
  for (std::size_t t = 0; t < factors.num_tiles(); ++t) {
    const std::vector<std::int32_t> tile = factors.tile(t);
    ASSERT_EQ(tile.size(), kTileValues * bits.size());
    for (std::size_t i = 0; i < kTileValues; ++i) {
      const std::size_t v = t * kTileValues + i;
      for (std::size_t k = 0; k < bits.size(); ++k) {
        const int scale = 1 << (spatial_factor_bits(bits[k]) - bits[k]);
        EXPECT_EQ(tile[i * bits.size() + k], v < kValues ? scale * value(k, v) : 0);
      }
    }
  }
}

TEST(ComponentSum, SumsNarrowWideAndMixedComponentsLikeThePlainTwin) {
  const std::vector<Widths> cases{
      {1, 16, 1, 16},    // all narrow
      {13, 16, 14, 16},  // narrow, in groups of few
      {17, 24, 1, 26},   // wide by their spatial factor
      {1, 24, 17, 26},   // wide by their temporal factor
      {1, 24, 1, 26},    // mixed
  };
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::size_t num_values = 3 * (random() % 50);
    const std::size_t num_frames = 1 + random() % 4;
    const std::size_t count = random() % 12;
    expect_sums_of_the_plain_twin(
        random_factors(random, cases[seed % 5], count, num_values, num_frames), num_values,
        num_frames);
  }
}

TEST(ComponentSum, SumsRowsOfATileLikeSingleRows) {
  std::mt19937 random(1);
  constexpr std::size_t kRows = 30;
  const std::vector<Factor> factors =
      random_factors(random, {1, 24, 1, 26}, 20, kTileValues + 5, kRows);
  const ComponentSum set = sum_of(factors, kTileValues + 5, kRows);
  std::vector<std::int64_t> sums((kRows - 1) * kTileValues);
  set.add_tile(1, 1, kRows - 1, sums);
  for (std::size_t r = 0; r + 1 < kRows; ++r) {
    const std::vector<std::int64_t> row_sums = sums_of(set, r + 1);
    for (std::size_t i = 0; i < kTileValues; ++i) {
      ASSERT_EQ(sums[r * kTileValues + i], i < 5 ? row_sums[kTileValues + i] : 0)
          << "row " << r << ", value " << i;
    }
  }
}

TEST(ComponentSum, ReadsSpatialValuesWithAStride) {
  const auto spatial = std::make_shared<SpatialFactors>(2);
  spatial->add(std::vector<std::int32_t>{5, 99, -7}, 13, 2);
  const ComponentSum set(spatial, std::vector<TemporalFactor>{{{3}, 3}}, 1);
  EXPECT_EQ(sums_of(set, 0), (std::vector<std::int64_t>{15, -21}));
}

// Factors that do not occur, and those after the last temporal factor, add nothing.
TEST(ComponentSum, LeavesOutComponentsThatDoNotOccur) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::vector<Factor> factors = random_factors(random, {1, 24, 1, 26}, 30, 7, 3);
    const auto spatial = std::make_shared<SpatialFactors>(7);
    std::vector<TemporalFactor> temporal;
    std::vector<Factor> left;
    for (std::size_t k = 0; k < factors.size(); ++k) {
      spatial->add(factors[k].spatial, factors[k].spatial_bits);
      if (k > 20) continue;
      const bool occurs = random() % 2 == 0;
      temporal.push_back(occurs ? TemporalFactor{factors[k].temporal, factors[k].temporal_bits}
                                : TemporalFactor{});
      if (occurs) left.push_back(factors[k]);
    }
    const ComponentSum set(spatial, temporal, 3);
    for (std::size_t f = 0; f < 3; ++f) {
      const std::vector<std::int64_t> sums = sums_of(set, f);
      const std::vector<Int128> plain = plain_sum(left, 7, f);
      for (std::size_t i = 0; i < 7; ++i) ASSERT_TRUE(plain[i] == sums[i]);
    }
  }
}

TEST(ComponentSum, IsZeroWithoutComponents) { expect_sums_of_the_plain_twin({}, 9, 2); }

// Factors at the extremes of their widths, in all combinations of signs, as many as a level
// allows.
void expect_saturating_sums(int spatial_bits, int temporal_bits, std::size_t count) {
  SCOPED_TRACE(testing::Message() << spatial_bits << " x " << temporal_bits);
  const std::int32_t s = 1 << (spatial_bits - 1);
  const std::int32_t t = 1 << (temporal_bits - 1);
  Factor f;
  f.spatial_bits = spatial_bits;
  f.temporal_bits = temporal_bits;
  f.spatial = {-s, s - 1, 0};
  f.temporal = {-t, t - 1};
  expect_sums_of_the_plain_twin(std::vector<Factor>(count, f), 3, 2);
}

TEST(ComponentSum, SumsOf1024SaturatingComponentsAreExact) {
  for (const int spatial_bits : {1, 2, 12, 13, 14, 15, 16, 17, 24}) {
    for (const int temporal_bits : {1, 2, 15, 16, 17, 26}) {
      expect_saturating_sums(spatial_bits, temporal_bits, 1024);
    }
  }
}

TEST(ComponentSum, GroupsOfNarrowComponentsNeverOverflow) {
  for (int spatial_bits = 13; spatial_bits <= 16; ++spatial_bits) {
    for (int temporal_bits = 1; temporal_bits <= 16; ++temporal_bits) {
      for (const std::size_t count : {1U, 2U, 3U, 4U, 5U, 7U, 8U, 9U, 33U}) {
        expect_saturating_sums(spatial_bits, temporal_bits, count);
      }
    }
  }
}

TEST(ComponentSum, SumOfTheLargestComponentsIsTwoToThe58) {
  const std::int32_t s = 1 << 23;
  const std::int32_t t = 1 << 25;
  const ComponentSum set =
      sum_of(std::vector<Factor>(1024, {{-t}, {-s, 0, s - 1}, 26, 24}), 3, 1);
  const std::vector<std::int64_t> sums = sums_of(set, 0);
  EXPECT_EQ(sums[0], std::int64_t{1} << 58);
  EXPECT_EQ(sums[1], 0);
  EXPECT_EQ(sums[2], -(std::int64_t{1} << 35) * (s - 1));
}

TEST(ScaleTable, IsTheRoundedPowerOfTwo) {
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(kScaleMantissa[static_cast<std::size_t>(i)],
              std::lround(std::exp2(i / 8.0) * 32768.0));
  }
}

TEST(ScaleTemporal, IsThePowerOfTwoOfTheSpecificationAndClips) {
  EXPECT_EQ(scale_temporal(1000, 32, 26), 1000);  // scale 1
  EXPECT_EQ(scale_temporal(-1000, 40, 26), -2000);
  EXPECT_EQ(scale_temporal(1000, 0, 26), 63);    // 62.5, up
  EXPECT_EQ(scale_temporal(-1000, 0, 26), -62);  // -62.5, up
  EXPECT_EQ(scale_temporal(1000, 36, 26), 1414);
  EXPECT_EQ(scale_temporal(1, 127, 26), 3756);  // 60097 / 16 = 3756.06
  EXPECT_EQ(scale_temporal(1000, 32, 10), 511);
  EXPECT_EQ(scale_temporal(-1000, 32, 10), -512);
  EXPECT_EQ(scale_temporal(5, 32, 1), 0);
  EXPECT_EQ(scale_temporal(-(1 << 23), 127, 26), -(1 << 25));
  EXPECT_EQ(scale_temporal((1 << 23) - 1, 127, 26), (1 << 25) - 1);
}

TEST(ScaleTemporal, GrowsWithScaleIdxByTheEighthRootOfTwo) {
  for (int idx = 32; idx < 120; ++idx) {
    const double ratio = scale_temporal(1 << 14, idx + 1, 26) /
                         static_cast<double>(scale_temporal(1 << 14, idx, 26));
    if (scale_temporal(1 << 14, idx + 1, 26) == (1 << 25) - 1) break;
    EXPECT_NEAR(ratio, 1.0905077, 1e-4) << idx;
  }
}

}  // namespace
}  // namespace rlpc
