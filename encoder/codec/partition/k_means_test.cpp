#include "encoder/codec/partition/k_means.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

TEST(KMeans, FindsClumps) {
  std::minstd_rand random(9);
  std::vector<double> points;  // four dimensions, in turn at three places
  for (int i = 0; i < 300; ++i) {
    for (int d = 0; d < 4; ++d) {
      points.push_back((i % 3 == 0   ? 0
                        : i % 3 == 1 ? 50
                                     : -80) +
                       static_cast<double>(random() % 10));
    }
  }
  const Partition partition = k_means(points, 4, 3);
  EXPECT_EQ(parts_of(partition).size(), 3U);
  for (std::size_t i = 3; i < 300; ++i) EXPECT_EQ(partition[i], partition[i % 3]);
}

TEST(KMeans, PutsEachPointWhereTheMeanIsNearest) {
  std::minstd_rand random(4);
  std::vector<double> points(2 * 60);
  for (double& x : points) x = static_cast<double>(random() % 1000);
  const Partition partition = k_means(points, 2, 5);
  const auto sizes = part_sizes(partition);
  ASSERT_EQ(sizes.size(), 5U);
  std::vector<double> means(10);
  for (std::size_t i = 0; i < points.size(); ++i) {
    means[2 * partition[i / 2] + i % 2] += points[i] / sizes[partition[i / 2]];
  }
  for (std::size_t i = 0; i < 60; ++i) {
    const auto away = [&](std::size_t k) {
      const double x = points[2 * i] - means[2 * k];
      const double y = points[2 * i + 1] - means[2 * k + 1];
      return x * x + y * y;
    };
    for (std::size_t k = 0; k < 5; ++k) EXPECT_LE(away(partition[i]), away(k) + 1e-6);
  }
}

TEST(KMeans, HasNoMoreCentresThanDifferentPoints) {
  const std::vector<double> points{2, 2, 5, 2, 5};
  EXPECT_EQ(parts_of(k_means(points, 1, 4)).size(), 2U);
  EXPECT_EQ(k_means(std::vector<double>(6, 3.0), 2, 4), (Partition{0, 0, 0}));
}

TEST(KMeans, TiesGoToTheFirstCentre) {
  // The centres are 0 (as far from the mean as 4, and before it) and 4, each with itself alone.
  const Partition partition = k_means(std::vector<double>{0, 4, 2, 2}, 1, 2);
  EXPECT_EQ(partition[2], partition[0]);
}

}  // namespace
}  // namespace rlpc
