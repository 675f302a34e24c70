#include "encoder/codec/partition/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

// Returns squared distances to the nearest points, by trying all.
std::vector<double> distances_to_all(const std::vector<Point3>& points, std::uint32_t of,
                                     std::size_t count) {
  std::vector<double> distances;
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    if (p != of) distances.push_back(squared_distance(points[p], points[of]));
  }
  std::sort(distances.begin(), distances.end());
  distances.resize(std::min(count, distances.size()));
  return distances;
}

void expect_nearest(const std::vector<Point3>& points, std::size_t count) {
  const PointTree tree(points);
  for (std::uint32_t of = 0; of < points.size(); ++of) {
    const std::vector<std::uint32_t> found = tree.nearest(of, count);
    std::vector<double> distances;
    distances.reserve(found.size());
    for (const std::uint32_t p : found) {
      distances.push_back(squared_distance(points[p], points[of]));
    }
    EXPECT_EQ(distances, distances_to_all(points, of, count)) << of;
    const std::set<std::uint32_t> different(found.begin(), found.end());
    EXPECT_EQ(different.size(), found.size());
    EXPECT_EQ(different.count(of), 0U);
  }
}

TEST(PointTree, FindsTheNearestPoints) {
  std::minstd_rand random(5);
  std::vector<Point3> points(400);
  for (Point3& p : points) {
    for (double& c : p) c = static_cast<double>(random() % 20);  // many equal coordinates
  }
  for (const std::size_t count : {0U, 1U, 6U, 500U}) expect_nearest(points, count);
}

TEST(PointTree, OfFewPoints) {
  expect_nearest({}, 3);
  expect_nearest({{1, 2, 3}}, 3);
  expect_nearest({{1, 2, 3}, {3, 2, 1}}, 3);
}

TEST(PointTree, OfPointsThatCoincide) {
  expect_nearest(std::vector<Point3>(100, Point3{1, 1, 1}), 6);
}

TEST(PointTree, TakesAboutAsLongForEachOfManyPointsThatCoincide) {
  const PointTree tree(std::vector<Point3>(200'000, Point3{}));  // all of all would be too many
  for (std::uint32_t of = 0; of < 200'000; of += 2) {
    ASSERT_EQ(tree.nearest(of, 6).size(), 6U);
  }
}

}  // namespace
}  // namespace rlpc
