#include "encoder/codec/partition/coarsening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "encoder/codec/partition/mesh_graph.h"
#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kAnyWeight = 1'000'000;

// Checks that the coarse graph is what merging makes of the fine one.
void expect_merged(const Graph& fine, const CoarseGraph& coarse) {
  std::vector<std::uint32_t> weight(coarse.graph.num_vertices());
  for (std::uint32_t v = 0; v < fine.num_vertices(); ++v) {
    weight[coarse.coarse_of[v]] += fine.weight[v];
  }
  EXPECT_EQ(coarse.graph.weight, weight);
  std::uint64_t between = 0;
  for (std::uint32_t v = 0; v < fine.num_vertices(); ++v) {
    for (std::uint32_t e = fine.first[v]; e < fine.first[v + 1]; ++e) {
      if (coarse.coarse_of[v] != coarse.coarse_of[fine.neighbour[e]]) {
        between += fine.edge_weight[e];
      }
    }
  }
  const auto& kept = coarse.graph.edge_weight;
  EXPECT_EQ(std::accumulate(kept.begin(), kept.end(), std::uint64_t{0}), between);
}

TEST(Coarsen, AboutHalvesAMesh) {
  PartitionScene scene;
  scene.add_grid(30, 20);
  const Graph fine = make_mesh_graph(scene.points, scene.triangles);
  const CoarseGraph coarse = coarsen(fine, kAnyWeight);
  expect_merged(fine, coarse);
  EXPECT_LE(coarse.graph.num_vertices(), 330U);
  EXPECT_GE(coarse.graph.num_vertices(), 300U);
  expect_merged(coarse.graph, coarsen(coarse.graph, kAnyWeight));
}

TEST(Coarsen, MergesAlongHeavyEdges) {
  const std::vector<GraphEdge> edges{{0, 1, 1}, {1, 2, 5}, {0, 3, 5}, {2, 3, 1}};
  const CoarseGraph coarse = coarsen(make_graph({1, 1, 1, 1}, edges), kAnyWeight);
  EXPECT_EQ(coarse.coarse_of, (std::vector<std::uint32_t>{0, 1, 1, 0}));
  EXPECT_EQ(coarse.graph.edge_weight, (std::vector<std::uint32_t>{2, 2}));
}

TEST(Coarsen, KeepsToTheLargestWeight) {
  PartitionScene scene;
  scene.add_grid(10, 10);
  Graph graph = make_mesh_graph(scene.points, scene.triangles);
  for (int i = 0; i < 8; ++i) graph = coarsen(graph, 7).graph;
  EXPECT_LE(*std::max_element(graph.weight.begin(), graph.weight.end()), 7U);
  EXPECT_LE(graph.num_vertices(), 29U);
}

// Two vertices of a star, and those without neighbours, have no edge to be merged along.
TEST(Coarsen, HalvesStarsAndLoneVertices) {
  std::vector<GraphEdge> edges;
  for (std::uint32_t v = 1; v < 400; ++v) edges.push_back({0, v, 1});
  for (const auto& chosen : {edges, std::vector<GraphEdge>{}}) {
    const Graph fine = make_graph(std::vector<std::uint32_t>(400, 1), chosen);
    const CoarseGraph coarse = coarsen(fine, kAnyWeight);
    expect_merged(fine, coarse);
    EXPECT_EQ(coarse.graph.num_vertices(), 200U);
  }
}

}  // namespace
}  // namespace rlpc
