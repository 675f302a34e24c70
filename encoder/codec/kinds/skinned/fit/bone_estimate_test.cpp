#include "encoder/codec/kinds/skinned/fit/bone_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

// Vertices on a line that all move by offset(frame).
template <typename Offset>
SpanFrames moving(std::uint32_t num_vertices, std::uint32_t num_frames, const Offset& offset) {
  SpanFrames frames{num_vertices, num_frames, {}};
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    for (std::uint32_t v = 0; v < num_vertices; ++v) {
      frames.xyz.insert(frames.xyz.end(), {10.0 * v, offset(f), 0.0});
    }
  }
  return frames;
}

TEST(Unsteadiness, IsTheDistanceFromLinearExtrapolation) {
  // Frame 1 is predicted by frame 0: 3 - 0. Frames 2 and 3 are extrapolated: 6 - 6, 4 - 9.
  const std::vector<double> offsets{0.0, 3.0, 6.0, 4.0};
  const SpanFrames frames = moving(2, 4, [&](std::uint32_t f) { return offsets[f]; });
  EXPECT_EQ(unsteadiness(frames), (std::vector<double>{3.0, 3.0, 0.0, 0.0, 5.0, 5.0}));
}

TEST(Unsteadiness, IsMeasuredAtAFewVertices) {
  const auto still = [](std::uint32_t) { return 1.0; };
  EXPECT_EQ(unsteadiness(moving(1000, 3, still)), std::vector<double>(2 * 143, 0.0));
  EXPECT_EQ(unsteadiness(moving(1, 3, still)).size(), 2U);
  EXPECT_TRUE(unsteadiness(moving(5, 1, still)).empty());
}

TEST(ExpectedBoneBits, GrowWithUnsteadinessFollowersAndFinerSteps) {
  const auto bits = [](double size, std::uint32_t vertices, std::size_t bones, double step) {
    const SpanFrames frames =
        moving(vertices, 50, [&](std::uint32_t f) { return size * std::sin(f); });
    return expected_bone_bits(unsteadiness(frames), frames, bones, step);
  };
  const double usual = bits(100.0, 400, 4, 10.0);
  EXPECT_GT(bits(200.0, 400, 4, 10.0), usual);
  EXPECT_GT(bits(100.0, 800, 4, 10.0), usual);
  EXPECT_LT(bits(100.0, 400, 8, 10.0), usual);
  EXPECT_NEAR(bits(100.0, 400, 16, 5.0), usual, 1e-9 * usual)
      << "half the distance, half the step";
}

TEST(ExpectedBoneBits, ABoneAtRestCostsNothing) {
  const SpanFrames frames = moving(100, 200, [](std::uint32_t) { return 7.0; });
  const SpanFrames one = moving(100, 1, [](std::uint32_t) { return 7.0; });
  EXPECT_EQ(expected_bone_bits(unsteadiness(frames), frames, 5, 1.0), 0.0);
  EXPECT_EQ(expected_bone_bits(unsteadiness(one), one, 5, 1.0), 0.0);
}

}  // namespace
}  // namespace rlpc
