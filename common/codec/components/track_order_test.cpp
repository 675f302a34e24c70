#include "common/codec/components/track_order.h"

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

// Every frame has one place; its predecessors come earlier, and not from a higher level.
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

std::vector<std::uint32_t> frames_of_layer(const TrackFrames& frames, int between, int layer) {
  std::vector<std::uint32_t> list;
  for (const TrackPlace& at : places_of_layer(frames, between, layer)) list.push_back(at.frame);
  return list;
}

TEST(PlacesOfLayer, AreThoseOfTheHighestLevels) {
  using Frames = std::vector<std::uint32_t>;
  const TrackFrames two{11, 2, 2};
  EXPECT_EQ(frames_of_layer(two, 1, 0), (Frames{0, 4, 8, 2, 6, 10}));
  EXPECT_EQ(frames_of_layer(two, 1, 1), (Frames{1, 3, 5, 7, 9}));
  const TrackFrames three{11, 2, 3};
  EXPECT_EQ(frames_of_layer(three, 2, 0), (Frames{0, 4, 8}));
  EXPECT_EQ(frames_of_layer(three, 2, 1), (Frames{2, 6, 10}));
  EXPECT_EQ(frames_of_layer(three, 2, 2), (Frames{1, 3, 5, 7, 9}));
}

TEST(PlacesOfLayer, OfASequentialTrackAreAllInTheFirst) {
  EXPECT_EQ(places_of_layer({11, 2, 3}, 0, 0).size(), 11U);
  EXPECT_TRUE(places_of_layer({11, 2, 3}, 0, 1).empty());
  EXPECT_TRUE(places_of_layer({11, 2, 3}, 0, 2).empty());
}

// The places of all layers together are the order of the track.
TEST(PlacesOfLayer, FollowTheOrderOfTheTrack) {
  for (int levels = 0; levels <= kMaxTrackLevels; ++levels) {
    for (int layers = 1; layers <= levels + 1; ++layers) {
      std::vector<std::uint32_t> all;
      for (int layer = 0; layer < layers; ++layer) {
        for (const std::uint32_t f : frames_of_layer({150, levels, layers}, 2, layer)) {
          all.push_back(f);
        }
      }
      std::vector<std::uint32_t> order;
      for (const TrackPlace& at : track_order(150, levels, 2)) order.push_back(at.frame);
      EXPECT_EQ(all, order) << levels << " " << layers;
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
