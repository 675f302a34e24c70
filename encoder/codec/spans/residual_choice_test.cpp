#include "encoder/codec/spans/residual_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "encoder/codec/spans/span_coder.h"

namespace rlpc {
namespace {

// Returns models adapted to zeros, so that all other residuals are expensive.
ResidualModels quiet_models() {
  ResidualModels models;
  BitCost cost;
  for (int i = 0; i < 200; ++i) write_residual(cost, models, 0, 0);
  return models;
}

TEST(CheaperResidual, RoundsToNearestBelowHalfAStep) {
  ResidualModels models = quiet_models();
  for (int i = -100; i < 100; ++i) {
    const double wanted = i + (i < 0 ? -0.49 : 0.49);
    EXPECT_EQ(cheaper_residual(models, 0, wanted), i) << wanted;
  }
}

TEST(CheaperResidual, IsLessThanAStepOff) {
  ResidualModels models = quiet_models();
  for (int i = -300; i < 300; ++i) {
    const double wanted = 0.171875 * i;
    const std::int32_t residual = cheaper_residual(models, 0, wanted);
    EXPECT_LT(std::abs(wanted - residual), 1.0) << wanted;
  }
}

TEST(CheaperResidual, StaysAtZeroIfOtherResidualsAreExpensive) {
  ResidualModels fresh;
  ResidualModels quiet = quiet_models();
  EXPECT_EQ(cheaper_residual(fresh, 0, 0.85), 1);
  EXPECT_EQ(cheaper_residual(quiet, 0, 0.65), 0);
  EXPECT_EQ(cheaper_residual(quiet, 0, -0.65), 0);
}

TEST(RoundedResidual, RoundsMagnitudes) {
  EXPECT_EQ(rounded_residual(2.5, 0.5), 3);
  EXPECT_EQ(rounded_residual(-2.5, 0.5), -3);
  EXPECT_EQ(rounded_residual(2.55, 0.42), 2);
  EXPECT_EQ(rounded_residual(-2.59, 0.42), -3);
  EXPECT_LE(rounded_residual(1e300, 0.5), kMaxResidual);
}

TEST(CheaperResidual, ClampsMagnitudes) {
  ResidualModels models;
  EXPECT_LE(cheaper_residual(models, 1000, 1e300), kMaxResidual);
  EXPECT_GE(cheaper_residual(models, 1000, -1e300), -std::int64_t{kMaxResidual});
}

}  // namespace
}  // namespace rlpc
