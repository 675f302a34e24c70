#include "encoder/codec/partition/bisection_refinement.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "encoder/codec/partition/mesh_graph.h"
#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

SideWeights weights(const Graph& graph, const Sides& side) {
  SideWeights sum{};
  for (std::uint32_t v = 0; v < graph.num_vertices(); ++v) sum[side[v]] += graph.weight[v];
  return sum;
}

TEST(RefineBisection, LeavesTheShortestCutOfAStrip) {
  PartitionScene scene;
  scene.add_grid(40, 4);
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  Sides side(160);
  // A cut with teeth.
  for (std::uint32_t v = 0; v < 160; ++v) side[v] = v % 40 >= (v / 40 % 2 == 0 ? 14U : 26U);
  refine_bisection(graph, {82, 82}, side);
  EXPECT_EQ(cut_weight(graph, side), kMeshEdge * (4 + 3));  // a column, and its diagonals
  EXPECT_LE(weights(graph, side)[0], 82);
  EXPECT_LE(weights(graph, side)[1], 82);
}

// The best single move makes the cut worse.
TEST(RefineBisection, PassesOverWorseStates) {
  // Two triangles, each with a vertex on the wrong side; 3 is heavily tied to 4.
  const std::vector<GraphEdge> edges{{0, 1, 4}, {0, 2, 4}, {1, 2, 4}, {3, 4, 9},
                                     {3, 5, 4}, {4, 5, 4}, {2, 3, 1}};
  const Graph graph = make_graph({1, 1, 1, 1, 1, 1}, edges);
  Sides side{0, 0, 1, 0, 0, 1};
  EXPECT_EQ(cut_weight(graph, side), 4 + 4 + 4 + 4 + 1);
  refine_bisection(graph, {4, 4}, side);
  EXPECT_EQ(cut_weight(graph, side), 1);
  EXPECT_EQ(side, (Sides{1, 1, 1, 0, 0, 0}));
}

TEST(RefineBisection, BalancesFirst) {
  PartitionScene scene;
  scene.add_grid(12, 12);
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  Sides side(144, 0);  // no edge is cut
  refine_bisection(graph, {100, 50}, side);
  const SideWeights now = weights(graph, side);
  EXPECT_LE(now[0], 100);
  EXPECT_GE(now[1], 44);
  EXPECT_LE(now[1], 50);
}

TEST(RefineBisection, KeepsAStateThatCannotBeBetter) {
  const Graph graph = make_graph({1, 1}, std::vector<GraphEdge>{{0, 1, 3}});
  Sides side{1, 0};
  refine_bisection(graph, {1, 1}, side);
  EXPECT_EQ(side, (Sides{1, 0}));
}

}  // namespace
}  // namespace rlpc
