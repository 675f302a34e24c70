#include "encoder/codec/sequence/step_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rlpc {
namespace {

// Frames whose error is a changing part of their step, and half of which outlasts a frame.
class Frames {
 public:
  explicit Frames(unsigned seed) : random_(seed) {}

  // Codes a frame with a step; returns its squared error.
  double code(double step) {
    std::normal_distribution<double> change(0.0, 0.05);
    ratio_ = std::clamp(ratio_ * std::exp(change(random_)), 0.6, 2.5);
    error_ = 0.5 * error_ + 0.5 * ratio_ * step;
    return error_ * error_;
  }

 private:
  std::mt19937 random_;
  double ratio_ = 1.6;
  double error_ = 1.0;
};

TEST(StepControl, KeepsTheErrorNearTheTarget) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Frames frames(seed);
    StepControl control;
    double sum = 0.0;
    for (int n = 1; n <= 300; ++n) {
      const double squared = frames.code(1.0 + control.delta() / 16.0);
      sum += squared;
      control.add(squared, n - sum);
      // RMS error of all frames so far, relative to the target.
      const double rms = std::sqrt(sum / n);
      ASSERT_NEAR(rms, 1.0, n < 60 ? 0.6 : n < 300 ? 0.06 : 0.02) << seed << ' ' << n;
    }
  }
}

TEST(StepControl, StaysWithinTheSyntax) {
  StepControl control;
  for (int n = 0; n < 100; ++n) control.add(1e9, -1e9);
  EXPECT_GE(control.delta(), kMinStepDelta);
  EXPECT_LT(control.factor(), 0.2);
  for (int n = 0; n < 100; ++n) control.add(0.0, 1e9);
  EXPECT_LE(control.delta(), kMaxStepDelta);
  EXPECT_GT(control.factor(), 5.0);
  control.start_again();
  EXPECT_EQ(control.delta(), 0);
}

}  // namespace
}  // namespace rlpc
