#include "encoder/codec/partition/bisection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "encoder/codec/partition/mesh_graph.h"
#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

std::int64_t on_side_0(const Sides& side) { return std::count(side.begin(), side.end(), 0); }

TEST(Bisect, CutsAGridAcross) {
  PartitionScene scene;
  scene.add_grid(60, 20);  // coarsened several times
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  const Sides side = bisect(graph, 1, 1);
  EXPECT_NEAR(static_cast<double>(on_side_0(side)), 600, 6);
  EXPECT_LE(cut_weight(graph, side), kMeshEdge * 45);  // a straight cut: 39
}

TEST(Bisect, CutsABridge) {
  PartitionScene scene;
  scene.add_grid(20, 20);
  scene.add_grid(20, 20, {300, 0, 0});
  scene.triangles.push_back({19, 400, 39});
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  EXPECT_EQ(cut_weight(graph, bisect(graph, 2, 2)), 2 * kMeshEdge);
}

TEST(Bisect, DividesInProportionToParts) {
  PartitionScene scene;
  scene.add_grid(30, 30);
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  EXPECT_NEAR(static_cast<double>(on_side_0(bisect(graph, 1, 2))), 300, 7);
  EXPECT_NEAR(static_cast<double>(on_side_0(bisect(graph, 7, 2))), 700, 8);
}

TEST(Bisect, LeavesEachPartAVertex) {
  PartitionScene scene;
  scene.add_grid(15, 10);
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  EXPECT_EQ(on_side_0(bisect(graph, 75, 75)), 75);
  EXPECT_EQ(on_side_0(bisect(graph, 1, 149)), 1);
  const Graph two = make_graph({1, 1}, std::vector<GraphEdge>{{0, 1, 1}});
  EXPECT_EQ(on_side_0(bisect(two, 1, 1)), 1);
}

TEST(Bisect, DividesGraphsThatAreNotConnected) {
  const Graph none = make_graph(std::vector<std::uint32_t>(3000, 1), {});
  EXPECT_NEAR(static_cast<double>(on_side_0(bisect(none, 1, 1))), 1500, 15);
  std::vector<GraphEdge> star;
  for (std::uint32_t v = 1; v < 2000; ++v) star.push_back({0, v, 1});
  const Graph graph = make_graph(std::vector<std::uint32_t>(3000, 1), star);
  const Sides side = bisect(graph, 1, 1);
  EXPECT_NEAR(static_cast<double>(on_side_0(side)), 1500, 15);
  EXPECT_LE(cut_weight(graph, side), 515);  // the lone vertices are on one side
}

}  // namespace
}  // namespace rlpc
