#include "encoder/frame_gof/repeated_frames.h"

#include <gtest/gtest.h>

#include <vector>

namespace rlpc {
namespace {

TEST(RepeatedFrames, AreEqualOnTheGrid) {
  const std::vector<double> xyz{0.4, -0.6, 7.0};
  EXPECT_TRUE(are_equal_on_grid(xyz, std::vector<double>{-0.4, -1.4, 7.3}));
  EXPECT_FALSE(are_equal_on_grid(xyz, std::vector<double>{0.6, -0.6, 7.0}));
}

// One value per frame.
TEST(RepeatedFrames, LastEqualFrameIsRepeated) {
  const std::vector<double> cycle{1, 2, 3, 1, 2, 2, 9};
  const FramePattern previous;
  EXPECT_EQ(repeat_distances(previous, cycle, 1, 100),
            (std::vector<std::uint32_t>{0, 0, 0, 3, 3, 1, 0}));
  EXPECT_EQ(repeat_distances(previous, cycle, 1, 2),
            (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 1, 0}));
}

// Coding order 0, 4, 2, 1, 3; frames 0, 4; 2; 1, 3 have depths 0, 1, 2.
TEST(RepeatedFrames, HigherTemporalLayersAreNotRepeated) {
  FramePattern dyadic;
  dyadic.kind = FramePattern::kDyadic;
  dyadic.period_log2 = 2;
  const std::vector<double> xyz{5, 6, 7, 7, 8, 9, 6, 9, 6};  // frames 1, 6, 8 are equal
  // Coding order of the second period: 8, 6, 5, 7.
  EXPECT_EQ(repeat_distances(dyadic, xyz, 1, 100),
            (std::vector<std::uint32_t>{0, 0, 0, 0, 2, 2, 1, 0, 1}));
  dyadic.temporal_layers = 3;
  EXPECT_EQ(repeat_distances(dyadic, xyz, 1, 100),
            (std::vector<std::uint32_t>{0, 0, 0, 0, 2, 0, 1, 0, 1}));
}

}  // namespace
}  // namespace rlpc
