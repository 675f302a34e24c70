#include "common/components/track_order.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

TEST(TrackOrder, IsThatOfTheFramesInSequentialTracks) {
  for (const auto& [levels, between] : {std::pair(0, 0), {0, 2}, {3, 0}}) {
    const std::vector<TrackPlace> order = track_order(20, levels, between);
    ASSERT_EQ(order.size(), 20U);
    for (std::uint32_t f = 0; f < 20; ++f) {
      EXPECT_EQ(order[f].frame, f);
      EXPECT_EQ(order[f].stride, 1U);
      EXPECT_EQ(order[f].level, 0);
      EXPECT_EQ(order[f].neighbours, 0);
    }
  }
}

TEST(TrackOrder, GoesLevelByLevel) {
  std::vector<std::uint32_t> frames;
  std::vector<int> neighbours;
  for (const TrackPlace& at : track_order(11, 2, 2)) {
    frames.push_back(at.frame);
    neighbours.push_back(at.neighbours);
  }
  EXPECT_EQ(frames, (std::vector<std::uint32_t>{0, 4, 8, 2, 6, 10, 1, 3, 5, 7, 9}));
  EXPECT_EQ(neighbours, (std::vector<int>{0, 0, 0, 2, 2, 0, 2, 4, 4, 4, 2}));
}

// Every frame has one place; what predicts it comes earlier, and not from a higher level.
TEST(TrackOrder, IsThatOfPrediction) {
  for (std::uint32_t num_frames = 1; num_frames < 300; num_frames += 1 + num_frames / 7) {
    for (int levels = 0; levels <= kMaxTrackLevels; ++levels) {
      std::vector<int> level_of(num_frames, -1);
      for (const TrackPlace& at : track_order(num_frames, levels, 2)) {
        ASSERT_LT(at.frame, num_frames);
        ASSERT_EQ(level_of[at.frame], -1);
        ASSERT_EQ(at.frame % at.stride, 0U);
        for (std::uint32_t f = 0; f < at.frame; f += at.stride) ASSERT_GE(level_of[f], 0);
        for (std::uint32_t k = 1; k < static_cast<std::uint32_t>(at.neighbours); k += 2) {
          ASSERT_GE(level_of[at.frame + k * at.stride], 0);
        }
        level_of[at.frame] = at.level;
      }
      for (const int level : level_of) ASSERT_GE(level, 0);
    }
  }
}

TEST(SumOfNeighbours, WeightsTwoOrFour) {
  const std::vector<std::int64_t> values{5, 0, 100, 0, 200, 0, 7};
  const auto series = [&](std::uint32_t f) { return values[f]; };
  EXPECT_EQ(sum_of_neighbours(series, {3, 1, 1, 2}), 300);
  EXPECT_EQ(sum_of_neighbours(series, {3, 1, 1, 4}), 9 * 300 - 12);
}

}  // namespace
}  // namespace rlpc
