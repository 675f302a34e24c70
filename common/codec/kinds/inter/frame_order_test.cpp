#include "common/codec/kinds/inter/frame_order.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

std::vector<FramePlace> places_of(const FramePattern& pattern, std::uint32_t num_frames) {
  const FrameOrder order(pattern, num_frames);
  std::vector<FramePlace> places;
  for (std::uint32_t i = 0; i < order.num_frames(); ++i) places.push_back(order[i]);
  return places;
}

TEST(FrameOrder, FollowsTheFramesWithOneReference) {
  FramePattern pattern;
  EXPECT_EQ(places_of(pattern, 4),
            (std::vector<FramePlace>{{0, 0, 0, 0}, {1, 0, 0, 0}, {2, 1, 1, 0}, {3, 2, 2, 0}}));
  pattern.kind = FramePattern::kFirst;
  EXPECT_EQ(places_of(pattern, 3),
            (std::vector<FramePlace>{{0, 0, 0, 0}, {1, 0, 0, 0}, {2, 0, 0, 0}}));
}

TEST(FrameOrder, OfDyadicPeriods) {
  FramePattern pattern;
  pattern.kind = FramePattern::kDyadic;
  pattern.period_log2 = 2;
  EXPECT_EQ(pattern.num_depths(), 3U);
  EXPECT_EQ(places_of(pattern, 8), (std::vector<FramePlace>{{0, 0, 0, 0},
                                                            {4, 0, 0, 0},
                                                            {2, 0, 4, 1},
                                                            {1, 0, 2, 2},
                                                            {3, 2, 4, 2},
                                                            {7, 4, 4, 0},  // rest of a period
                                                            {5, 4, 7, 1},
                                                            {6, 5, 7, 2}}));
}

TEST(FrameOrder, OfExplicitPeriods) {
  FramePattern pattern;
  pattern.kind = FramePattern::kExplicit;
  pattern.entries = {{3, {0, 0}, 0}, {1, {0, 3}, 2}, {2, {1, 3}, 2}};
  EXPECT_EQ(places_of(pattern, 6), (std::vector<FramePlace>{{0, 0, 0, 0},
                                                            {3, 0, 0, 0},
                                                            {1, 0, 3, 2},
                                                            {2, 1, 3, 2},
                                                            {4, 3, 3, 0},  // rest of a period
                                                            {5, 4, 4, 0}}));
}

TEST(FrameOrder, EveryFrameOnceAfterItsReferences) {
  FramePattern pattern;
  pattern.kind = FramePattern::kDyadic;
  for (int log2 = 1; log2 <= kMaxPatternPeriodLog2; ++log2) {
    pattern.period_log2 = log2;
    for (std::uint32_t n = 1; n < 150; ++n) {
      const FrameOrder order(pattern, n);
      ASSERT_EQ(order.num_frames(), n);
      for (std::uint32_t p = 1; p < n; ++p) {
        const FramePlace& place = order[p];
        EXPECT_EQ(order.place_of(place.frame), p);
        EXPECT_LT(order.place_of(place.first), p);
        EXPECT_LT(order.place_of(place.second), p);
        EXPECT_GE(order.last_use(place.first), p);
        EXPECT_GE(order.last_use(place.second), p);
        EXPECT_LT(place.depth, pattern.num_depths());
        EXPECT_GE(place.depth, order[order.place_of(place.first)].depth);
      }
    }
  }
}

TEST(FrameOrder, DyadicPeriodsKeepFewFrames) {
  FramePattern pattern;
  pattern.kind = FramePattern::kDyadic;
  pattern.period_log2 = 5;
  const FrameOrder order(pattern, 129);
  for (std::uint32_t p = 0; p < 129; ++p) {
    std::uint32_t kept = 0;
    for (std::uint32_t q = 0; q <= p; ++q) {
      if (order.last_use(order[q].frame) > p) ++kept;
    }
    EXPECT_LE(kept, 7U);  // NOTE in 8.19.1
  }
}

TEST(FramePattern, TheDeepestFramesAreTheHighestLayers) {
  FramePattern pattern;
  pattern.kind = FramePattern::kDyadic;
  pattern.period_log2 = 3;
  pattern.temporal_layers = 3;
  const std::vector<std::uint32_t> expected{0, 0, 1, 2};
  for (std::uint32_t depth = 0; depth < 4; ++depth) {
    EXPECT_EQ(pattern.temporal_layer(depth), expected[depth]);
  }
}

TEST(FrameOrder, OfAShorterGofBeginsTheSame) {
  FramePattern pattern;
  const FrameOrder whole(pattern, 10);
  EXPECT_TRUE(FrameOrder(pattern, 6).begins_as(whole, 6));
  EXPECT_FALSE(FrameOrder(pattern, 6).begins_as(whole, 7));
  pattern.kind = FramePattern::kDyadic;
  pattern.period_log2 = 2;
  const FrameOrder dyadic(pattern, 13);
  EXPECT_TRUE(FrameOrder(pattern, 7).begins_as(dyadic, 5));
  EXPECT_FALSE(FrameOrder(pattern, 7).begins_as(dyadic, 6));  // 6 instead of 8
  EXPECT_TRUE(FrameOrder(pattern, 9).begins_as(dyadic, 9));
}

}  // namespace
}  // namespace rlpc
