#include "encoder/codec/partition/mesh_graph.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

// Returns the number of vertices that can be reached from vertex 0.
std::size_t reached(const Graph& graph) {
  std::vector<bool> seen(graph.num_vertices());
  std::vector<std::uint32_t> found{0};
  seen[0] = true;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const std::uint32_t u : graph.neighbours(found[i])) {
      if (seen[u]) continue;
      seen[u] = true;
      found.push_back(u);
    }
  }
  return found.size();
}

std::size_t edges_of_weight(const Graph& graph, std::uint32_t min, std::uint32_t max) {
  std::size_t count = 0;
  for (const std::uint32_t w : graph.edge_weight) count += w >= min && w <= max;
  return count / 2;
}

TEST(MeshGraph, HasTheEdgesOfAConnectedMesh) {
  PartitionScene scene;
  scene.add_grid(4, 3);
  scene.triangles.push_back(scene.triangles[0]);
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  EXPECT_EQ(edges_of_weight(graph, kMeshEdge, kMeshEdge), 9U + 8U + 6U);
  EXPECT_EQ(graph.neighbour.size(), 2U * 23U);
  EXPECT_EQ(graph.weight, std::vector<std::uint32_t>(12, 1));
}

TEST(MeshGraph, LinksComponentsToTheNearestOnes) {
  PartitionScene scene;
  for (int i = 0; i < 20; ++i) scene.add_grid(2, 2, {100.0 * i, 0, 0});
  scene.points.push_back({1000, 0, 500});
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  EXPECT_EQ(reached(graph), 81U);
  EXPECT_EQ(edges_of_weight(graph, kMeshEdge, kMeshEdge), 20U * 5U);
  // Both directions of a link may be chosen.
  EXPECT_EQ(edges_of_weight(graph, kLink, 2 * kLink) + 100U, graph.neighbour.size() / 2);
  // The right side of a component is linked to the left one of the next.
  for (const std::uint32_t u : graph.neighbours(1)) EXPECT_TRUE(u < 4 || u % 2 == 0) << u;
}

TEST(MeshGraph, ConnectsClumpsOfPoints) {
  PartitionScene scene;
  for (int i = 0; i < 5; ++i) scene.add_grid(5, 5, {10000.0 * i, 0, 0});
  EXPECT_EQ(reached(make_mesh_graph(scene.points, {})), 125U);
}

TEST(MeshGraph, ConnectsPointsThatCoincide) {
  const std::vector<Point3> points(500, Point3{});
  const Graph graph = make_mesh_graph(points, {});
  EXPECT_EQ(reached(graph), 500U);
  EXPECT_LE(graph.neighbour.size(), 2U * 6U * 500U);
}

TEST(MeshGraph, OfOneVertex) {
  const Graph graph = make_mesh_graph(std::vector<Point3>(1), {});
  EXPECT_EQ(graph.num_vertices(), 1U);
  EXPECT_TRUE(graph.neighbour.empty());
}

}  // namespace
}  // namespace rlpc
