#include "encoder/codec/kinds/skinned/recover/robust_error.h"

#include <gtest/gtest.h>

#include <vector>

namespace rlpc {
namespace {

TEST(RobustScale, IsTwiceTheErrorThatThreeFifthsDoNotExceed) {
  EXPECT_DOUBLE_EQ(robust_scale({0.5, 0.1, 9.0, 0.2, 0.3}), 1.0);
  EXPECT_DOUBLE_EQ(robust_scale({0.5, 0.1, 9e9, 0.2, 0.3}), 1.0);
  EXPECT_DOUBLE_EQ(robust_scale({0.25}), 0.5);
}

TEST(RobustScale, IsNeverFinerThanWhatMatters) {
  EXPECT_DOUBLE_EQ(robust_scale({0.0, 0.0, 1e-9}), 5e-5);
}

TEST(RobustCost, AddsTheLogarithmsOfErrors) {
  EXPECT_DOUBLE_EQ(robust_cost(std::vector<double>{}, 1.0), 0.0);
  EXPECT_DOUBLE_EQ(robust_cost(std::vector{0.5, 0.0}, 0.5), 1.0);
  EXPECT_NEAR(robust_cost(std::vector{512.0}, 0.5), 20.0, 1e-5);
}

// The weight is the derivative of the cost by the squared error, up to a constant.
TEST(RobustWeight, IsThatOfTheCost) {
  constexpr double kScale = 0.3;
  const auto slope = [&](double error) {
    constexpr double kStep = 1e-4;
    const double more = robust_cost(std::vector{error + kStep}, kScale);
    const double less = robust_cost(std::vector{error - kStep}, kScale);
    return (more - less) / (4.0 * kStep * error);
  };
  for (const double error : {0.05, 0.3, 1.0, 4.0}) {
    EXPECT_NEAR(robust_weight(error, kScale) / robust_weight(1.0, kScale),
                slope(error) / slope(1.0), 1e-4);
  }
  EXPECT_DOUBLE_EQ(robust_weight(0.0, kScale), 1.0);
}

}  // namespace
}  // namespace rlpc
