#include "common/codec/bits/bit_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>

namespace rlpc {
namespace {

constexpr std::uint32_t kLowest = 71;
constexpr std::uint32_t kHighest = 65465;

TEST(BitModel, StartsAtOneHalf) { EXPECT_EQ(BitModel().probability(), 32768U); }

TEST(BitModel, ReachesBothBoundsAndStaysThere) {
  BitModel zeros;
  BitModel ones;
  for (int i = 0; i < 5000; ++i) {
    zeros.update(false);
    ones.update(true);
  }
  EXPECT_EQ(zeros.probability(), kLowest);
  EXPECT_EQ(ones.probability(), kHighest);
  for (int i = 0; i < 100; ++i) {
    zeros.update(false);
    ones.update(true);
    ASSERT_EQ(zeros.probability(), kLowest);
    ASSERT_EQ(ones.probability(), kHighest);
  }
}

TEST(BitModel, NeverLeavesItsBounds) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    BitModel model;
    for (int i = 0; i < 20000; ++i) {
      // Long runs of one value approach both bounds; then it changes suddenly.
      const bool bin = random() % 8 == 0;
      const std::uint64_t run = 1 + random() % (1U << (random() % 11));
      for (std::uint64_t k = 0; k < run && i < 20000; ++k, ++i) {
        model.update(bin);
        ASSERT_GE(model.probability(), kLowest);
        ASSERT_LE(model.probability(), kHighest);
      }
    }
  }
}

// The first bins have full weight: the first moves both estimates half way.
TEST(BitModel, LearnsFastAtFirst) {
  BitModel model;
  model.update(true);
  EXPECT_EQ(model.probability(), 49152U);
  model.update(true);
  EXPECT_EQ(model.probability(), 49152U + 16384U / 4);
  BitModel other;
  other.update(false);
  EXPECT_EQ(other.probability(), 16384U);
  other.update(true);
  EXPECT_EQ(other.probability(), 16384U + 49152U / 4);
}

TEST(BitModel, EveryBinMovesTheProbabilityTowardsIt) {
  constexpr unsigned kSeed = 3;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  BitModel model;
  for (int i = 0; i < 50000; ++i) {
    const std::uint32_t before = model.probability();
    const bool bin = random() % 10 < 3;
    model.update(bin);
    if (bin) {
      ASSERT_GE(model.probability(), before);
    } else {
      ASSERT_LE(model.probability(), before);
    }
  }
}

TEST(BitModel, ConvergesToTheFractionOfOnes) {
  for (const unsigned per_mille : {20U, 100U, 500U, 800U, 980U}) {
    constexpr unsigned kSeed = 4;
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", " << per_mille << " per mille");
    std::mt19937 random(kSeed);
    BitModel model;
    double sum = 0.0;
    constexpr int kBins = 40000;
    for (int i = 0; i < kBins; ++i) {
      model.update(random() % 1000 < per_mille);
      sum += model.probability() / 65536.0;
    }
    EXPECT_NEAR(sum / kBins, per_mille / 1000.0, 0.01);
  }
}

}  // namespace
}  // namespace rlpc
