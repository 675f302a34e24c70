#include "common/codec/components/series_predictor.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace rlpc {
namespace {

std::int64_t predict(const std::vector<std::int64_t>& values, std::uint32_t f, int order) {
  return predict_series([&](std::uint32_t g) { return values.at(g); }, f, order);
}

TEST(PredictSeries, OrderZeroPredictsZero) {
  const std::vector<std::int64_t> values{9, -4, 7, 100, 3};
  for (std::uint32_t f = 0; f < 5; ++f) EXPECT_EQ(predict(values, f, 0), 0);
}

TEST(PredictSeries, OrderIsAtMostTheNumberOfPredecessors) {
  const std::vector<std::int64_t> values{9, -4, 7, 100, 3};
  for (std::uint32_t f = 0; f < 5; ++f) {
    for (int order = 0; order <= 4; ++order) {
      const int used = order < static_cast<int>(f) ? order : static_cast<int>(f);
      EXPECT_EQ(predict(values, f, order), predict(values, f, used)) << f << " " << order;
    }
  }
  EXPECT_EQ(predict(values, 0, 4), 0);
  EXPECT_EQ(predict(values, 1, 4), 9);
  EXPECT_EQ(predict(values, 2, 4), 2 * -4 - 9);
  EXPECT_EQ(predict(values, 3, 4), 3 * 7 - 3 * -4 + 9);
  EXPECT_EQ(predict(values, 4, 4), 4 * 100 - 6 * 7 + 4 * -4 - 9);
}

TEST(PredictSeries, OrderAboveTheDegreeOfAPolynomialIsExact) {
  constexpr unsigned kSeed = 1;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int i = 0; i < 100; ++i) {
    for (int degree = 0; degree <= 3; ++degree) {
      std::array<std::int64_t, 4> factor{};
      for (int k = 0; k <= degree; ++k) {
        factor[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(random() % 2001) - 1000;
      }
      if (factor[static_cast<std::size_t>(degree)] == 0) {
        factor[static_cast<std::size_t>(degree)] = 1;
      }
      std::vector<std::int64_t> values;
      for (std::int64_t x = -5; x < 15; ++x) {
        values.push_back(factor[0] + x * (factor[1] + x * (factor[2] + x * factor[3])));
      }
      for (std::uint32_t f = 4; f < values.size(); ++f) {
        for (int order = degree + 1; order <= 4; ++order) {
          ASSERT_EQ(predict(values, f, order), values[f]) << degree << " " << order;
        }
        // The next lower order is off by the highest difference, a non-zero constant.
        ASSERT_TRUE(degree == 0 || predict(values, f, degree) != values[f]);
      }
    }
  }
}

TEST(PredictSeries, IsAtMostFifteenTimesTheLargestPosition) {
  const std::int64_t max = std::int64_t{1} << 23;
  EXPECT_EQ(predict({max, -max, max, -max}, 4, 4), -15 * max);
}

}  // namespace
}  // namespace rlpc
