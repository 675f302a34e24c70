#include "encoder/codec/partition/graph.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

TEST(Graph, MergesEdgesAndDropsLoops) {
  const std::vector<GraphEdge> edges{{0, 1, 2}, {1, 0, 3}, {2, 2, 7}, {2, 1, 1}};
  const Graph graph = make_graph({1, 1, 4, 9}, edges);
  EXPECT_EQ(graph.num_vertices(), 4U);
  EXPECT_EQ(graph.first, (std::vector<std::uint32_t>{0, 1, 3, 4, 4}));
  EXPECT_EQ(graph.neighbour, (std::vector<std::uint32_t>{1, 0, 2, 1}));
  EXPECT_EQ(graph.edge_weight, (std::vector<std::uint32_t>{5, 5, 1, 1}));
  EXPECT_EQ(graph.weight, (std::vector<std::uint32_t>{1, 1, 4, 9}));
  EXPECT_TRUE(graph.neighbours(3).empty());
}

TEST(Graph, WithoutVertices) {
  const Graph graph = make_graph({}, {});
  EXPECT_EQ(graph.num_vertices(), 0U);
  EXPECT_EQ(graph.first, std::vector<std::uint32_t>{0});
}

TEST(Subgraph, HasTheEdgesBetweenItsVertices) {
  const std::vector<GraphEdge> edges{{0, 1, 2}, {1, 2, 3}, {2, 4, 5}, {1, 4, 6}};
  const Graph graph = make_graph({1, 2, 3, 4, 5}, edges);
  const std::vector<std::uint8_t> side{1, 0, 1, 1, 1};
  const Subgraph sub = subgraph(graph, side, 1);
  EXPECT_EQ(sub.original, (std::vector<std::uint32_t>{0, 2, 3, 4}));
  EXPECT_EQ(sub.graph.weight, (std::vector<std::uint32_t>{1, 3, 4, 5}));
  EXPECT_EQ(sub.graph.first, (std::vector<std::uint32_t>{0, 0, 1, 1, 2}));
  EXPECT_EQ(sub.graph.neighbour, (std::vector<std::uint32_t>{3, 1}));
  EXPECT_EQ(sub.graph.edge_weight, (std::vector<std::uint32_t>{5, 5}));
  EXPECT_EQ(subgraph(graph, side, 0).original, std::vector<std::uint32_t>{1});
}

}  // namespace
}  // namespace rlpc
