#include "encoder/codec/math/inverse_iteration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace rlpc {
namespace {

using Vectors = std::vector<std::vector<double>>;

void expect_orthonormal(const Vectors& vectors) {
  for (std::size_t a = 0; a < vectors.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      double dot = 0.0;
      for (std::size_t i = 0; i < vectors[a].size(); ++i) dot += vectors[a][i] * vectors[b][i];
      EXPECT_NEAR(dot, a == b ? 1.0 : 0.0, 1e-12) << a << ", " << b;
    }
  }
}

// The second difference, 2 on the diagonal and -1 next to it, has known values and vectors:
// cosines and sines.
TEST(TridiagonalEigenvectors, AreSinesForTheSecondDifference) {
  constexpr std::size_t kWidth = 120;
  constexpr double kPi = std::numbers::pi;
  const std::vector<double> diagonal(kWidth, 2.0);
  const std::vector<double> subdiagonal(kWidth - 1, -1.0);
  std::vector<double> values;
  for (std::size_t k = kWidth; k > kWidth / 2; --k) {
    values.push_back(2.0 - 2.0 * std::cos(kPi * static_cast<double>(k) / (kWidth + 1)));
  }
  const auto vectors = tridiagonal_eigenvectors(diagonal, subdiagonal, values);
  ASSERT_TRUE(vectors.has_value());
  ASSERT_EQ(vectors->size(), values.size());
  expect_orthonormal(*vectors);
  const double scale = std::sqrt(2.0 / (kWidth + 1));
  for (std::size_t l = 0; l < values.size(); ++l) {
    const std::vector<double>& v = (*vectors)[l];
    const double sign = v[0] < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < kWidth; ++i) {
      const double turn = kPi * static_cast<double>((kWidth - l) * (i + 1)) / (kWidth + 1);
      EXPECT_NEAR(sign * v[i], scale * std::sin(turn), 1e-11) << l << ", " << i;
    }
  }
}

TEST(TridiagonalEigenvectors, AreOrthogonalForEqualValues) {
  // Decoupled blocks, each with the values 3 and 1.
  constexpr std::size_t kBlocks = 20;
  std::vector<double> diagonal;
  std::vector<double> subdiagonal;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    diagonal.insert(diagonal.end(), {2.0, 2.0});
    subdiagonal.insert(subdiagonal.end(), {1.0, 0.0});
  }
  subdiagonal.pop_back();
  std::vector<double> values(kBlocks, 3.0);
  values.insert(values.end(), kBlocks, 1.0);
  const auto vectors = tridiagonal_eigenvectors(diagonal, subdiagonal, values);
  ASSERT_TRUE(vectors.has_value());
  expect_orthonormal(*vectors);
  for (std::size_t l = 0; l < values.size(); ++l) {
    for (std::size_t i = 0; i < diagonal.size(); i += 2) {
      const double sign = l < kBlocks ? 1.0 : -1.0;
      EXPECT_NEAR((*vectors)[l][i], sign * (*vectors)[l][i + 1], 1e-12);
    }
  }
}

TEST(TridiagonalEigenvectors, IsOneForASingleElement) {
  const auto vectors =
      tridiagonal_eigenvectors(std::vector<double>{5.0}, {}, std::vector<double>{5.0});
  ASSERT_TRUE(vectors.has_value());
  EXPECT_EQ(std::abs(vectors->at(0).at(0)), 1.0);
}

TEST(TridiagonalEigenvectors, AreNoneForANumberThatIsNoEigenvalue) {
  const std::vector<double> diagonal{1.0, 2.0, 3.0};
  const std::vector<double> subdiagonal{0.5, 0.5};
  EXPECT_FALSE(
      tridiagonal_eigenvectors(diagonal, subdiagonal, std::vector<double>{2.5}).has_value());
}

}  // namespace
}  // namespace rlpc
