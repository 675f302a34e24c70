#include "encoder/codec/partition/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "encoder/codec/partition/mesh_graph.h"
#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

// A sheet of 40 columns that is folded along column 20: to the left it descends.
PartitionScene folded(double slope) {
  PartitionScene scene;
  scene.add_grid(41, 5);
  for (Point3& p : scene.points) p[2] = slope * std::abs(p[0] - 200.0);
  return scene;
}

double length(const Graph& graph, const std::vector<double>& lengths, std::uint32_t a,
              std::uint32_t b) {
  for (std::uint32_t e = graph.first[a]; e < graph.first[a + 1]; ++e) {
    if (graph.neighbour[e] == b) return lengths[e];
  }
  ADD_FAILURE() << a << " and " << b << " have no edge";
  return 0.0;
}

TEST(SurfaceLengths, AreLongAcrossConcaveCreases) {
  // Triangles face upwards: an upward fold is convex, a downward one concave.
  const PartitionScene roof = folded(-1.0);
  const PartitionScene valley = folded(1.0);
  const Graph graph = make_mesh_graph(roof.points, roof.triangles);
  const auto roof_lengths = surface_lengths(graph, roof.points, roof.triangles);
  const auto valley_lengths = surface_lengths(graph, valley.points, valley.triangles);
  const std::uint32_t middle = 2 * 41 + 20;
  const double flat = length(graph, valley_lengths, middle - 5, middle - 4);
  const double concave = length(graph, valley_lengths, middle - 1, middle);
  EXPECT_GT(concave, 50 * flat);
  // Relative to their means, which the fold determines, both are alike, so compare a sheet with
  // both.
  PartitionScene both;
  both.add_grid(41, 5);
  for (Point3& p : both.points) p[2] = p[0] < 100 ? p[0] : p[0] < 300 ? 200 - p[0] : p[0] - 400;
  const auto lengths = surface_lengths(graph, both.points, both.triangles);
  const double up = length(graph, lengths, 2 * 41 + 9, 2 * 41 + 10);
  const double down = length(graph, lengths, 2 * 41 + 29, 2 * 41 + 30);
  EXPECT_GT(down, 4 * up);
  EXPECT_EQ(roof_lengths.size(), graph.neighbour.size());
}

TEST(SurfaceLengths, AreGeodesicInPointClouds) {
  PartitionScene scene;
  scene.points = {{0, 0, 0}, {10, 0, 0}, {30, 0, 0}};
  const Graph graph = make_graph({1, 1, 1}, std::vector<GraphEdge>{{0, 1, 1}, {1, 2, 1}});
  const auto lengths = surface_lengths(graph, scene.points, {});
  EXPECT_GT(lengths[0], 0.0);
  EXPECT_NEAR(length(graph, lengths, 1, 2), 2.0 * lengths[0], 1e-12);
}

TEST(SampleSurface, CoversAPathEvenly) {
  std::vector<GraphEdge> edges;
  for (std::uint32_t v = 1; v < 41; ++v) edges.push_back({v - 1, v, 1});
  const Graph graph = make_graph(std::vector<std::uint32_t>(41, 1), edges);
  const std::vector<double> lengths(graph.neighbour.size(), 1.0);
  const SurfaceSamples samples = sample_surface(graph, lengths, 5);  // 0, 40, 20, 10, 30
  ASSERT_EQ(samples.count, 5U);
  EXPECT_EQ(samples.nearest[0], 0U);
  EXPECT_EQ(samples.nearest[40], 1U);
  EXPECT_EQ(samples.nearest[21], 2U);
  EXPECT_EQ(samples.nearest[9], 3U);
  EXPECT_EQ(samples.nearest[31], 4U);
  const double expected[5][5] = {{0, 40, 20, 10, 30},
                                 {40, 0, 20, 30, 10},
                                 {20, 20, 0, 10, 10},
                                 {10, 30, 10, 0, 20},
                                 {30, 10, 10, 20, 0}};
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_DOUBLE_EQ(samples.distance[i], expected[i / 5][i % 5]) << i;
  }
}

TEST(SampleSurface, StopsWhereNothingIsFar) {
  const Graph graph = make_graph({1, 1, 1}, std::vector<GraphEdge>{{0, 1, 1}, {1, 2, 1}});
  const SurfaceSamples samples = sample_surface(graph, std::vector<double>(4, 0.0), 3);
  EXPECT_EQ(samples.count, 1U);
  EXPECT_EQ(samples.nearest, (std::vector<std::uint32_t>{0, 0, 0}));
  EXPECT_EQ(samples.distance, std::vector<double>{0.0});
}

}  // namespace
}  // namespace rlpc
