#include "encoder/codec/math/small_system.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace rlpc {
namespace {

// A system a x = b with positive definite a and known x.
template <std::size_t N>
void expect_recovered(std::mt19937& random, std::size_t n) {
  const auto number = [&] { return static_cast<double>(random() % 2001) / 1000.0 - 1.0; };
  std::array<std::array<double, N>, N> root{};
  std::array<double, N> x{};
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = number();
    for (std::size_t j = 0; j < n; ++j) root[i][j] = number();
  }
  SmallSystem<N> system;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) system.a[i][j] += root[k][i] * root[k][j];
      if (i == j) system.a[i][j] += 0.1;
    }
    for (std::size_t j = 0; j < n; ++j) system.b[i] += system.a[i][j] * x[j];
  }
  const auto solution = solve_small(system, n);
  EXPECT_TRUE(solution.is_unique);
  for (std::size_t i = 0; i < N; ++i) EXPECT_NEAR(solution.x[i], x[i], 1e-9) << i;
}

TEST(SolveSmall, RecoversTheUnknowns) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    for (std::size_t n = 1; n <= 3; ++n) expect_recovered<3>(random, n);
    for (std::size_t n = 1; n <= 4; ++n) expect_recovered<4>(random, n);
  }
}

TEST(SolveSmall, SetsUnknownsWithoutAPivotToZero) {
  SmallSystem<3> system;
  system.a = {{{2.0, 0.0, 4.0}, {0.0, 0.0, 0.0}, {4.0, 0.0, 9.0}}};
  system.b = {10.0, 0.0, 21.0};
  const auto solution = solve_small(system);
  EXPECT_FALSE(solution.is_unique);
  EXPECT_DOUBLE_EQ(solution.x[0], 3.0);
  EXPECT_EQ(solution.x[1], 0.0);
  EXPECT_DOUBLE_EQ(solution.x[2], 1.0);
}

TEST(SolveSmall, PivotsMustExceedLeastPivot) {
  SmallSystem<3> system;
  system.a = {{{1.0, 0.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.0}}};
  system.b = {1.0, 1.0, 1.0};
  EXPECT_TRUE(solve_small(system, 3, 0.4).is_unique);
  EXPECT_FALSE(solve_small(system, 3, 0.5).is_unique);
}

}  // namespace
}  // namespace rlpc
