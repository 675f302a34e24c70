#include "encoder/codec/math/matrix_products.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <vector>

namespace rlpc {
namespace {

std::vector<double> random_values(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::vector<double> values(count);
  for (double& x : values) x = static_cast<double>(random()) / 1e9 - 2.0;
  return values;
}

TEST(OrderedProduct, SumsInTheOrderOfTheRows) {
  for (const std::size_t width : {0U, 1U, 3U, 4U, 7U, 384U}) {
    for (const std::size_t b_width : {0U, 1U, 5U, 33U}) {
      const std::vector<double> row = random_values(1, width);
      const std::vector<double> b = random_values(2, width * b_width);
      std::vector<double> expected(b_width, 0.0);
      for (std::size_t k = 0; k < b_width; ++k) {
        for (std::size_t j = 0; j < width; ++j) expected[k] += row[j] * b[j * b_width + k];
      }
      EXPECT_EQ(ordered_product(row, b, b_width), expected) << width << ' ' << b_width;
    }
  }
}

TEST(MatrixProduct, IsTheSameRowByRow) {
  constexpr std::size_t kRows = 5;
  constexpr std::size_t kInner = 9;
  constexpr std::size_t kWidth =
      11;  // width of a, of which only the first kInner columns are used
  constexpr std::size_t kBWidth = 6;
  const std::vector<double> a = random_values(3, kRows * kWidth);
  const std::vector<double> b = random_values(4, kInner * kBWidth);
  const std::vector<double> all = matrix_product(a, kWidth, b, kBWidth);
  for (std::size_t r = 0; r < kRows; ++r) {
    std::vector<double> row(kBWidth, 0.0);
    add_matrix_product(std::span(a).subspan(r * kWidth, kInner), kInner, b, kBWidth, row);
    for (std::size_t k = 0; k < kBWidth; ++k) {
      EXPECT_EQ(row[k], all[r * kBWidth + k]);
      double sum = 0.0;
      for (std::size_t i = 0; i < kInner; ++i) sum += a[r * kWidth + i] * b[i * kBWidth + k];
      EXPECT_NEAR(row[k], sum, 1e-12);
    }
  }
}

TEST(GramMatrix, IsTheSameFourRowsAtATime) {
  constexpr std::size_t kRows = 14;
  constexpr std::size_t kWidth = 6;
  const std::vector<double> rows = random_values(5, kRows * kWidth);
  std::vector<double> some(kWidth * kWidth, 0.0);
  for (std::size_t r = 0; r < kRows; r += 4) {
    const std::size_t count = std::min<std::size_t>(4, kRows - r);
    add_gram_matrix(std::span(rows).subspan(r * kWidth, count * kWidth), kWidth, some);
  }
  EXPECT_EQ(some, gram_matrix(rows, kWidth));
  for (std::size_t i = 0; i < kWidth; ++i) {
    for (std::size_t j = 0; j < kWidth; ++j) {
      double sum = 0.0;
      for (std::size_t r = 0; r < kRows; ++r)
        sum += rows[r * kWidth + i] * rows[r * kWidth + j];
      EXPECT_NEAR(some[i * kWidth + j], j > i ? 0.0 : sum, 1e-12);
    }
  }
}

TEST(OuterProduct, IsAddedToTheSum) {
  std::vector<double> sum{1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  add_outer_product(0.5, std::vector{1.0, -2.0}, std::vector{2.0, 4.0, 8.0}, sum);
  EXPECT_EQ(sum, (std::vector{2.0, 4.0, 7.0, 2.0, 1.0, -2.0}));
}

TEST(SubtractMultiple, Subtracts) {
  std::vector<double> to{1.0, 2.0, 3.0};
  subtract_multiple(2.0, std::vector{0.5, 0.25, -1.0}, to);
  EXPECT_EQ(to, (std::vector{0.0, 1.5, 5.0}));
}

}  // namespace
}  // namespace rlpc
