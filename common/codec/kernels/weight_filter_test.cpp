// Compares every loop that the machine supports with the text of the specification (8.15).
#include "common/codec/kernels/weight_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "common/codec/kernels/kernels.h"
#include "common/testing/filter_of_text.h"

namespace rlpc {
namespace {

class EachFilter : public testing::TestWithParam<std::size_t> {
 protected:
  const Kernels& loops() const { return kernels()[GetParam()]; }

  void start(std::size_t ring, std::size_t size, int shift, std::mt19937_64& random) {
    std::vector<std::int32_t> weights(size);
    for (std::int32_t& w : weights) {
      w = static_cast<std::int32_t>(random() % (2 * kMaxAdaptiveWeight + 1)) -
          kMaxAdaptiveWeight;
    }
    filter_.start(weights, ring, shift);
    text_.ring = ring;
    text_.weight.assign(weights.begin(), weights.end());
    text_.start_spread(shift);
  }

  // 8.19: starts a filter whose last five of `size` offsets are not neighbours.
  void start_of_frames(std::size_t ring, std::size_t size, std::mt19937_64& random) {
    start(ring, size, kSpreadShift, random);
    text_.is_of_frames = true;
    text_.neighbours = size - 5;
    text_.start_spread_of_frames();
    for (std::size_t i = 0; i < size; ++i) {
      filter_.walk[i] = static_cast<std::int32_t>(text_.random_walk(i));
      filter_.spread[i * filter_.stride + i] = static_cast<std::int32_t>(text_.spread[i][i]);
    }
  }

  void step(const FilterOfText::List& offsets, std::int64_t error, std::int64_t variance = 0) {
    std::vector<std::int32_t> padded(kMaxFilterSize, 0);
    std::copy(offsets.begin(), offsets.end(), padded.begin());
    ASSERT_EQ(loops().predict_offset(filter_.state(), padded.data()),
              text_.predict_offset(offsets));
    if (text_.is_of_frames) {
      loops().adapt_to_frame(filter_.state(), padded.data(), error, variance);
    } else {
      loops().adapt(filter_.state(), padded.data(), error);
    }
    ASSERT_NO_FATAL_FAILURE(text_.adapt(offsets, error, variance));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      ASSERT_EQ(filter_.weight[i], text_.weight[i]) << "weight " << i;
      for (std::size_t j = 0; j < offsets.size(); ++j) {
        ASSERT_EQ(filter_.spread[i * filter_.stride + j], text_.spread[i][j])
            << "spread " << i << ", " << j;
      }
    }
  }

  // Returns a number within 2^bits; often at the ends, or zero.
  static std::int64_t number(std::mt19937_64& random, int bits) {
    const std::int64_t max = std::int64_t{1} << bits;
    switch (random() % 8) {
      case 0:
        return max;
      case 1:
        return -max;
      case 2:
        return 0;
      default:
        return static_cast<std::int64_t>(random() % (2 * static_cast<std::uint64_t>(max))) -
               max;
    }
  }

  WeightFilter filter_;
  FilterOfText text_;
};

TEST_P(EachFilter, AdaptsToAnyOffsetsAndErrors) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const std::size_t ring = 2 + random() % 6;
    const std::size_t size = ring + random() % 25;
    start(ring, size, seed % 2 == 0 ? kSpreadShift : kLaterSpreadShift, random);
    for (int k = 0; k < 40; ++k) {
      const int bits = static_cast<int>(random() % 25);
      const int error_bits = static_cast<int>(random() % 34);
      FilterOfText::List offsets(size);
      for (std::int64_t& x : offsets) x = number(random, bits);
      ASSERT_NO_FATAL_FAILURE(step(offsets, number(random, error_bits))) << "step " << k;
    }
  }
}

// The same direction repeatedly, or opposite directions, where spread is closest to losing its
// definiteness.
TEST_P(EachFilter, AdaptsToOffsetsThatHardlyDiffer) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    start(7, 31, kSpreadShift, random);
    const int bits = static_cast<int>(random() % 25);
    FilterOfText::List offsets(31);
    for (std::int64_t& x : offsets) x = number(random, bits);
    for (int k = 0; k < 100; ++k) {
      const std::int64_t error = number(random, static_cast<int>(random() % 30));
      ASSERT_NO_FATAL_FAILURE(step(offsets, error)) << "step " << k;
      offsets[random() % 31] += bits < 24 ? static_cast<std::int64_t>(random() % 3) - 1 : 0;
      if (seed % 2 == 0) {
        for (std::int64_t& x : offsets) x = -x;
      }
    }
  }
}

// 8.19: offsets, errors and variances of any size; directions that repeat.
TEST_P(EachFilter, AdaptsToAnyFrames) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const std::size_t ring = random() % 8;
    start_of_frames(ring, ring + random() % 13 + 5, random);
    const std::size_t size = filter_.size;
    FilterOfText::List offsets(size);
    for (int k = 0; k < 60; ++k) {
      if (seed % 3 != 0 || k == 0) {
        const int bits = static_cast<int>(random() % 31);
        for (std::int64_t& x : offsets) x = number(random, bits);
      } else {
        for (std::int64_t& x : offsets) x = -x;
      }
      const std::int64_t error = number(random, static_cast<int>(random() % 40));
      const std::int64_t variance = std::int64_t{1} << random() % 61;
      ASSERT_NO_FATAL_FAILURE(step(offsets, error, variance)) << "step " << k;
    }
  }
}

// Samples without noise, in few directions: the sharpest possible. Rounding must not leave a
// remainder or a negative value, or the filter diverges with more samples.
TEST_P(EachFilter, LearnsFromSharpSamplesWithoutDiverging) {
  constexpr std::size_t kSize = 24;
  constexpr std::size_t kDirections = 5;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    start_of_frames(6, kSize, random);
    std::fill_n(filter_.weight.begin(), kSize, 0);
    std::vector<std::vector<std::int32_t>> directions(kDirections);
    for (auto& direction : directions) {
      direction.assign(kMaxFilterSize, 0);
      for (std::size_t i = 0; i < kSize; ++i) {
        direction[i] = static_cast<std::int32_t>(number(random, 12));
      }
    }
    std::int64_t largest_error = 0;
    for (int k = 0; k < 2000; ++k) {
      std::vector<std::int32_t> offsets(kMaxFilterSize, 0);
      std::int64_t value = 0;
      for (const auto& direction : directions) {
        const auto part = static_cast<std::int32_t>(random() % 9) - 4;
        for (std::size_t i = 0; i < kSize; ++i) offsets[i] += part * direction[i];
        value += part * std::int64_t{direction[0] - direction[1]} / 2;
      }
      const std::int64_t error =
          value - loops().predict_offset(filter_.state(), offsets.data());
      if (k >= 100) largest_error = std::max(largest_error, std::abs(error));
      loops().adapt_to_frame(filter_.state(), offsets.data(), error, 1 << 14);
    }
    EXPECT_LT(largest_error, 64);  // values are up to 2^16
  }
}

// An example worked by hand: two neighbours of the ring, one of the outer ring.
TEST_P(EachFilter, TakesTheStepOfTheText) {
  filter_.start(std::vector<std::int32_t>{32768, 32768, 0}, 2, kSpreadShift);
  std::vector<std::int32_t> offsets(kMaxFilterSize, 0);
  offsets[0] = 16;
  offsets[1] = -16;
  offsets[2] = 8;
  EXPECT_EQ(loops().predict_offset(filter_.state(), offsets.data()), 0);
  loops().adapt(filter_.state(), offsets.data(), 10);
  // Spread is 1/256 and 1/1024, gain = (16, -16, 2) / 256, scale = 1 + 2.0625 * 1025 / 1024,
  // and weights
  // change by gain * 10 / scale = (0.20395, -0.20395, 0.02549), times 2^16.
  EXPECT_EQ(filter_.weight[0], 32768 + 13365);
  EXPECT_EQ(filter_.weight[1], 32768 - 13365);
  EXPECT_EQ(filter_.weight[2], 1670);
}

INSTANTIATE_TEST_SUITE_P(OfTheMachine, EachFilter,
                         testing::Range<std::size_t>(0, kernels().size()));

}  // namespace
}  // namespace rlpc
