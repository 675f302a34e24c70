#include "encoder/codec/kinds/cluster/clustering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

namespace rlpc {
namespace {

constexpr int kSceneBits = 20;  // position_bits

using Point = std::array<double, 3>;

struct Scene {
  SpanFrames frames;
  std::vector<Triangle> triangles;

  // Adds a frame; all frames must have the same number of vertices.
  void add_frame(const std::vector<Point>& points) {
    frames.num_vertices = static_cast<std::uint32_t>(points.size());
    ++frames.num_frames;
    for (const Point& p : points) frames.xyz.insert(frames.xyz.end(), p.begin(), p.end());
  }
};

std::vector<Point> box_points(const Point& corner, double size) {
  std::vector<Point> points(8);
  for (int i = 0; i < 8; ++i) {
    points[static_cast<std::size_t>(i)] = {corner[0] + size * (i & 1),
                                           corner[1] + size * ((i >> 1) & 1),
                                           corner[2] + size * (i >> 2)};
  }
  return points;
}

void add_box_triangles(std::vector<Triangle>& triangles, std::uint32_t first) {
  for (const std::array<std::uint32_t, 4>& q :
       std::vector<std::array<std::uint32_t, 4>>{{0, 2, 3, 1},
                                                 {4, 5, 7, 6},
                                                 {0, 1, 5, 4},
                                                 {2, 6, 7, 3},
                                                 {0, 4, 6, 2},
                                                 {1, 3, 7, 5}}) {
    triangles.push_back({first + q[0], first + q[1], first + q[2]});
    triangles.push_back({first + q[0], first + q[2], first + q[3]});
  }
}

// A static box, and one that moves away from it and turns by 90 degrees in each frame; rounding
// to the grid is exact for both.
Scene two_boxes() {
  Scene scene;
  add_box_triangles(scene.triangles, 0);
  add_box_triangles(scene.triangles, 8);
  for (int f = 0; f < 5; ++f) {
    std::vector<Point> points = box_points({0, 0, 0}, 100);
    for (Point p : box_points({0, 0, 0}, 70)) {
      for (int turn = 0; turn < f; ++turn) p = {-p[1], p[0], p[2]};
      points.push_back({p[0] + 400 + 31 * f, p[1] + 10 * f, p[2] - 7 * f});
    }
    scene.add_frame(points);
  }
  return scene;
}

void expect_boxes_apart(const Clustering& clustering) {
  ASSERT_EQ(clustering.seeds.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const bool moving = clustering.seeds[i][0] >= 8;
    for (const std::uint32_t v : clustering.seeds[i]) EXPECT_EQ(v >= 8, moving);
    for (std::uint32_t v = 0; v < 16; ++v) {
      EXPECT_EQ(clustering.cluster_of_vertex[v] == i, (v >= 8) == moving) << v;
    }
  }
}

TEST(MotionClusters, SeparateTwoBoxesThatMoveApart) {
  const Scene scene = two_boxes();
  MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
  expect_boxes_apart(motion.clusters(2));
}

TEST(MotionClusters, SeparateTwoBoxesWithSpreadSeeds) {
  const Scene scene = two_boxes();
  MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
  const Clustering clustering = motion.spread_clusters(2);
  expect_boxes_apart(clustering);
  for (const Seed& s : clustering.seeds) {
    EXPECT_EQ(std::set<std::uint32_t>(s.begin(), s.end()).size(), 3U);
  }
}

TEST(MotionClusters, SeedsAreMeshTrianglesRotatedToTheirLongestEdge) {
  const Scene scene = two_boxes();
  MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
  for (const Seed& s : motion.clusters(6).seeds) {
    const std::array<Triangle, 3> turns{Triangle{s[0], s[1], s[2]}, Triangle{s[1], s[2], s[0]},
                                        Triangle{s[2], s[0], s[1]}};
    EXPECT_TRUE(std::any_of(turns.begin(), turns.end(), [&](const Triangle& t) {
      return std::find(scene.triangles.begin(), scene.triangles.end(), t) !=
             scene.triangles.end();
    }));
    const auto length2 = [&](std::size_t a, std::size_t b) {
      double sum = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = scene.frames.at(0, s[a])[c] - scene.frames.at(0, s[b])[c];
        sum += d * d;
      }
      return sum;
    };
    EXPECT_GE(length2(0, 1), length2(1, 2));
    EXPECT_GE(length2(0, 1), length2(2, 0));
  }
}

TEST(MotionClusters, SeedsMayBeTheFirstTriangles) {
  Scene scene = two_boxes();
  SeedRules rules;
  rules.first = true;
  for (int i = 0; i < 2; ++i) {
    MotionClusters motion(scene.frames, scene.triangles, kSceneBits, rules);
    const Clustering clustering = motion.clusters(2);
    ASSERT_EQ(clustering.seeds.size(), 2U);
    // The farthest vertices are met by these triangles first, whichever comes first.
    for (const Seed& seed : clustering.seeds) {
      const auto is_seed = [&](const Triangle& t) { return t == seed; };
      const auto at = std::find_if(scene.triangles.begin(), scene.triangles.end(), is_seed);
      ASSERT_NE(at, scene.triangles.end()) << "turned";
      const auto earlier_with = [&](std::uint32_t v) {
        return std::any_of(scene.triangles.begin(), at, [&](const Triangle& t) {
          return std::find(t.begin(), t.end(), v) != t.end();
        });
      };
      EXPECT_FALSE(std::all_of(seed.begin(), seed.end(), earlier_with));
    }
    std::reverse(scene.triangles.begin(), scene.triangles.end());
  }
}

TEST(MotionClusters, PlainSumsForgiveOneGreatMotion) {
  // Point 6 keeps to the first triangle, but for one jump; it makes this with the second
  // triangle, against which it moves a little in every frame.
  Scene scene;
  scene.triangles = {{0, 1, 2}, {3, 4, 5}, {0, 1, 6}};
  constexpr int kFrames = 40;
  for (int f = 0; f < kFrames; ++f) {
    const double jump = f >= kFrames / 2 ? 1500.0 : 0.0;
    const double away = 40.0 * f + jump;
    scene.add_frame({{0, 0, 0},
                     {1000, 0, 0},
                     {0, 1000, 0},
                     {away, 0, 9000},
                     {away + 1000, 0, 9000},
                     {away, 1000, 9000},
                     {jump, 0, 2000}});
  }
  for (const DistanceSum sum : {DistanceSum::kSquared, DistanceSum::kPlain}) {
    SeedRules rules;
    rules.sum = sum;
    MotionClusters motion(scene.frames, scene.triangles, kSceneBits, rules);
    const Clustering clustering = motion.clusters(2);
    ASSERT_EQ(clustering.seeds.size(), 2U);
    const std::uint16_t first = clustering.cluster_of_vertex[0];
    EXPECT_EQ(clustering.cluster_of_vertex[6] == first, sum == DistanceSum::kPlain);
  }
}

TEST(MotionClusters, SeedsOfAPointCloudAreNearbyPoints) {
  Scene scene = two_boxes();
  scene.triangles.clear();
  MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
  const Clustering clustering = motion.clusters(2);
  expect_boxes_apart(clustering);
  for (const Seed& s : clustering.seeds) {
    EXPECT_EQ(std::set<std::uint32_t>(s.begin(), s.end()).size(), 3U);
  }
  expect_boxes_apart(motion.spread_clusters(2));
}

TEST(MotionClusters, CollinearOrCoincidentPointsGiveNoSeeds) {
  for (const double step : {0.0, 50.0}) {
    Scene scene;
    std::vector<Point> points;
    points.reserve(9);
    for (int i = 0; i < 9; ++i) points.push_back({step * i, 0, 0});
    scene.add_frame(points);
    MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
    for (const bool spread : {false, true}) {
      const Clustering clustering = spread ? motion.spread_clusters(3) : motion.clusters(3);
      EXPECT_TRUE(clustering.seeds.empty()) << step;
      EXPECT_EQ(clustering.cluster_of_vertex, std::vector<std::uint16_t>(9, 0));
    }
  }
}

TEST(MotionClusters, IsolatedVerticesOfAMeshGiveNoSeeds) {
  Scene scene = two_boxes();
  scene.triangles.resize(scene.triangles.size() / 2);  // the triangles of the first box
  MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
  for (const Seed& s : motion.clusters(8).seeds) {
    for (const std::uint32_t v : s) EXPECT_LT(v, 8U);
  }
}

// A strip of squares along x; column i consists of the vertices 2 i and 2 i + 1.
Scene strip(int columns, const std::vector<double>& heights) {
  Scene scene;
  for (std::uint32_t i = 0; i + 1 < static_cast<std::uint32_t>(columns); ++i) {
    scene.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    scene.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
  }
  for (const double height : heights) {
    std::vector<Point> points;
    for (int i = 0; i < columns; ++i) {
      points.push_back({100.0 * i, 0, height});
      points.push_back({100.0 * i, 100, height});
    }
    scene.add_frame(points);
  }
  return scene;
}

TEST(MotionClusters, SeedsAreFarApart) {
  const Scene scene = strip(33, {0, 0});
  MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
  const Clustering clustering = motion.clusters(5);
  ASSERT_EQ(clustering.seeds.size(), 5U);
  std::vector<std::uint32_t> columns;
  for (const Seed& s : clustering.seeds) columns.push_back(s[0] / 2);
  // The ends, then the middle, then the quarters.
  EXPECT_GE(std::max(columns[0], columns[1]), 31U);
  EXPECT_LE(std::min(columns[0], columns[1]), 1U);
  EXPECT_NEAR(columns[2], 16, 1);
  std::sort(columns.begin() + 3, columns.end());
  EXPECT_NEAR(columns[3], 8, 2);
  EXPECT_NEAR(columns[4], 24, 2);
}

TEST(MotionClusters, SeedsOfFewerClustersAreAPrefix) {
  const Scene scene = two_boxes();
  MotionClusters once(scene.frames, scene.triangles, kSceneBits);
  const std::vector<Seed> eight = once.clusters(8).seeds;
  for (const std::uint32_t count : {1U, 3U, 8U, 2U}) {
    MotionClusters other(scene.frames, scene.triangles, kSceneBits);
    const Clustering a = once.clusters(count);  // one object handles all counts
    const Clustering b = other.clusters(count);
    EXPECT_EQ(a.seeds, b.seeds);
    EXPECT_EQ(a.cluster_of_vertex, b.cluster_of_vertex);
    EXPECT_EQ(a.seeds, (std::vector<Seed>{eight.begin(), eight.begin() + count}));
  }
}

TEST(MotionClusters, TiesGoToTheFirstSeed) {
  const Scene scene = strip(9, {0, 50, 20});  // moves as a whole
  MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
  const Clustering clustering = motion.clusters(4);
  EXPECT_EQ(clustering.seeds.size(), 4U);
  EXPECT_EQ(clustering.cluster_of_vertex, std::vector<std::uint16_t>(18, 0));
}

// In one frame, the ends of the strip shrink to points, to lines or below the grid step.
TEST(MotionClusters, TrianglesDegenerateInAnyFrameAreNoSeeds) {
  for (const int kind : {0, 1, 2}) {
    Scene scene = strip(9, {0, 0, 0});
    double* p = &scene.frames.xyz[std::size_t{18} * 3];  // frame 1
    const auto set = [&](std::size_t v, const Point& to) {
      std::copy(to.begin(), to.end(), p + 3 * v);
    };
    for (const std::size_t end : {std::size_t{0}, std::size_t{14}}) {
      const double x = p[3 * end];
      set(end, {x, 0, 0});
      set(end + 1, {x, kind == 1 ? 50.0 : kind == 2 ? 0.25 : 0.0, 0});
      set(end + 2, {x, kind == 1 ? 70.0 : 0.0, kind == 2 ? 0.25 : 0.0});
      set(end + 3, {x, kind == 1 ? 80.0 : 0.0, 0});
    }
    MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
    const Clustering clustering = motion.clusters(100);
    EXPECT_GE(clustering.seeds.size(), 2U) << kind;
    EXPECT_LT(clustering.seeds.size(), 18U) << kind;
    for (const Seed& s : clustering.seeds) {
      const auto [low, high] = std::minmax_element(s.begin(), s.end());
      EXPECT_FALSE(*high < 4 || *low >= 14) << kind;
    }
  }
}

TEST(MotionClusters, HaveNoSeedsIfAllVerticesCoincide) {
  Scene scene = strip(4, {});
  scene.add_frame(std::vector<Point>(8, Point{5, 5, 5}));
  MotionClusters motion(scene.frames, scene.triangles, kSceneBits);
  EXPECT_TRUE(motion.clusters(2).seeds.empty());
}

}  // namespace
}  // namespace rlpc
