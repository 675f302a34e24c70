#include "encoder/codec/kinds/inter/earlier_frames.h"

#include <gtest/gtest.h>

#include <vector>

namespace rlpc {
namespace {

TEST(EarlierFrames, AreEqualOnTheGrid) {
  const std::vector<double> xyz{0.4, -0.6, 7.0};
  EXPECT_TRUE(are_equal_on_grid(xyz, std::vector<double>{-0.4, -1.4, 7.3}));
  EXPECT_FALSE(are_equal_on_grid(xyz, std::vector<double>{0.6, -0.6, 7.0}));
}

std::vector<std::uint32_t> equal(const std::vector<EarlierFrame>& frames) {
  std::vector<std::uint32_t> distances;
  distances.reserve(frames.size());
  for (const EarlierFrame& frame : frames) {
    distances.push_back(frame.is_equal ? frame.distance : 0);
  }
  return distances;
}

// One value per frame.
TEST(EarlierFrames, LastEqualFrameCounts) {
  const std::vector<double> cycle{1, 2, 3, 1, 2, 2, 9};
  const FramePattern previous;
  EXPECT_EQ(equal(earlier_frames(previous, cycle, 1, 100)),
            (std::vector<std::uint32_t>{0, 0, 0, 3, 3, 1, 0}));
  EXPECT_EQ(equal(earlier_frames(previous, cycle, 1, 2)),
            (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 1, 0}));
}

TEST(EarlierFrames, NearestFrameCountsIfTheReferenceIsFarther) {
  const std::vector<double> poses{100, 200, 300, 103, 202, 190};
  const std::vector<EarlierFrame> expected{{}, {}, {}, {3, false}, {3, false}, {4, false}};
  EXPECT_EQ(earlier_frames(FramePattern{}, poses, 1, 100), expected);
  const std::vector<EarlierFrame> near{{}, {}, {1, false}, {3, false}, {3, false}, {4, false}};
  const FramePattern first{FramePattern::kFirst, 1, {}, 1};
  EXPECT_EQ(earlier_frames(first, poses, 1, 100)[2], near[2]);
}

// Coding order 0, 4, 2, 1, 3; frames 0, 4; 2; 1, 3 have depths 0, 1, 2.
TEST(EarlierFrames, HigherTemporalLayersDoNotCount) {
  FramePattern dyadic;
  dyadic.kind = FramePattern::kDyadic;
  dyadic.period_log2 = 2;
  const std::vector<double> xyz{5, 6, 7, 7, 8, 9, 6, 9, 6};  // frames 1, 6, 8 are equal
  // Coding order of the second period: 8, 6, 5, 7.
  EXPECT_EQ(equal(earlier_frames(dyadic, xyz, 1, 100)),
            (std::vector<std::uint32_t>{0, 0, 0, 0, 2, 2, 1, 0, 1}));
  dyadic.temporal_layers = 3;
  EXPECT_EQ(equal(earlier_frames(dyadic, xyz, 1, 100)),
            (std::vector<std::uint32_t>{0, 0, 0, 0, 2, 0, 1, 0, 1}));
}

}  // namespace
}  // namespace rlpc
