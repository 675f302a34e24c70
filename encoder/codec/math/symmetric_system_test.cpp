#include "encoder/codec/math/symmetric_system.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace rlpc {
namespace {

// root^T root, where root has `rank` rows, plus a diagonal matrix.
std::vector<double> gram(std::mt19937& random, std::size_t n, std::size_t rank,
                         double diagonal) {
  std::vector<double> root(rank * n);
  for (double& x : root) x = static_cast<double>(random() % 2001) / 1000.0 - 1.0;
  std::vector<double> a(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < rank; ++k) a[i * n + j] += root[k * n + i] * root[k * n + j];
    }
    a[i * n + i] += diagonal;
  }
  return a;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& x,
                            std::size_t n, std::size_t width) {
  std::vector<double> b(n * width);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < width; ++k)
        b[i * width + k] += a[i * n + j] * x[j * width + k];
    }
  }
  return b;
}

TEST(SymmetricSystem, RecoversTheUnknownsOfAllRightSides) {
  std::mt19937 random(1);
  for (const std::size_t n : {1U, 2U, 7U, 40U}) {
    for (const std::size_t width : {1U, 2U, 5U, 33U}) {
      std::vector<double> a = gram(random, n, n, 0.1);
      std::vector<double> x(n * width);
      for (double& v : x) v = static_cast<double>(random() % 2001) / 1000.0 - 1.0;
      std::vector<double> b = product(a, x, n, width);
      for (std::size_t i = 0; i < n; ++i) {  // only the upper triangle is read
        for (std::size_t j = 0; j < i; ++j) a[i * n + j] = 1e9;
      }
      const SymmetricSystem system(a, n);
      EXPECT_TRUE(system.is_unique());
      system.solve(b, width);
      for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(b[i], x[i], 1e-8) << n << " " << i;
    }
  }
}

// Each right side has bit-exactly the same solution as alone.
TEST(SymmetricSystem, RightSidesAreIndependent) {
  std::mt19937 random(2);
  constexpr std::size_t kUnknowns = 9;
  constexpr std::size_t kWidth = 6;
  const SymmetricSystem system(gram(random, kUnknowns, kUnknowns, 0.1), kUnknowns);
  std::vector<double> together(kUnknowns * kWidth);
  for (double& v : together) v = static_cast<double>(random() % 2001) / 1000.0 - 1.0;
  std::vector<std::vector<double>> alone(kWidth, std::vector<double>(kUnknowns));
  for (std::size_t i = 0; i < together.size(); ++i) {
    alone[i % kWidth][i / kWidth] = together[i];
  }
  system.solve(together, kWidth);
  for (std::vector<double>& b : alone) system.solve(b);
  for (std::size_t i = 0; i < together.size(); ++i) {
    EXPECT_EQ(together[i], alone[i % kWidth][i / kWidth]) << i;
  }
}

TEST(SymmetricSystem, SetsUnknownsWithoutAPivotToZeroAndSolvesTheOthers) {
  std::mt19937 random(3);
  constexpr std::size_t kUnknowns = 6;
  const std::vector<double> a = gram(random, kUnknowns, 4, 0.0);
  std::vector<double> x(kUnknowns);
  for (double& v : x) v = static_cast<double>(random() % 2001) / 1000.0 - 1.0;
  const std::vector<double> wanted = product(a, x, kUnknowns, 1);
  const SymmetricSystem system(a, kUnknowns, 1e-9);
  EXPECT_FALSE(system.is_unique());
  std::vector<double> solution = wanted;
  system.solve(solution);
  EXPECT_EQ(solution[4], 0.0);
  EXPECT_EQ(solution[5], 0.0);
  const std::vector<double> reached = product(a, solution, kUnknowns, 1);
  for (std::size_t i = 0; i < kUnknowns; ++i) EXPECT_NEAR(reached[i], wanted[i], 1e-9) << i;
}

}  // namespace
}  // namespace rlpc
