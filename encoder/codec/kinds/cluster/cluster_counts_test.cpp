#include "encoder/codec/kinds/cluster/cluster_counts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rlpc {
namespace {

struct Climbed {
  std::size_t best;
  std::vector<std::size_t> places;  // in the order in which they were compared
};

// Climbs to the place with the lowest cost.
Climbed climb_to(double place, std::size_t start, std::size_t last, std::size_t stride) {
  Climbed climbed{0, {}};
  climbed.best = climb(start, last, stride, [&](std::size_t i) {
    climbed.places.push_back(i);
    return std::abs(static_cast<double>(i) - place);
  });
  return climbed;
}

TEST(Climb, FollowsTheFallingCostEitherWay) {
  EXPECT_EQ(climb_to(6.0, 4, 9, 1).best, 6U);
  EXPECT_EQ(climb_to(1.0, 4, 9, 1).best, 1U);
  EXPECT_EQ(climb_to(4.0, 4, 9, 1).places, (std::vector<std::size_t>{4, 5, 3}));
}

TEST(Climb, ComparesEachPlaceOnce) {
  EXPECT_EQ(climb_to(6.0, 4, 9, 1).places, (std::vector<std::size_t>{4, 5, 6, 7}));
  EXPECT_EQ(climb_to(1.0, 4, 9, 1).places, (std::vector<std::size_t>{4, 5, 3, 2, 1, 0}));
}

TEST(Climb, StaysBetweenTheFirstAndTheLast) {
  EXPECT_EQ(climb_to(20.0, 4, 9, 1).best, 9U);
  EXPECT_EQ(climb_to(20.0, 4, 9, 2).best, 8U);
  EXPECT_EQ(climb_to(-5.0, 5, 9, 2).best, 1U);
  EXPECT_EQ(climb_to(3.0, 4, 2, 1).places, (std::vector<std::size_t>{2, 1}));
  EXPECT_EQ(climb_to(3.0, 4, 0, 1).places, std::vector<std::size_t>{0});
}

TEST(LastClusterCount, LeavesVerticesBesidesSeeds) {
  EXPECT_EQ(last_cluster_count(1, 10), 0U);
  EXPECT_EQ(last_cluster_count(6, 10), 0U);
  EXPECT_EQ(last_cluster_count(7, 10), 1U);  // two clusters have six seeds
  EXPECT_EQ(last_cluster_count(1000000, 10), 9U);
}

}  // namespace
}  // namespace rlpc
