#include "encoder/codec/partition/kway.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "encoder/codec/partition/bisection_refinement.h"
#include "encoder/codec/partition/mesh_graph.h"
#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

TEST(Kway, MakesEqualPartsWithShortBorders) {
  PartitionScene scene;
  scene.add_grid(64, 64);
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  const Partition partition = kway_partition(graph, 16);
  const auto sizes = part_sizes(partition);
  ASSERT_EQ(sizes.size(), 16U);
  EXPECT_LE(*std::max_element(sizes.begin(), sizes.end()), 256U * 105 / 100);
  EXPECT_GE(*std::min_element(sizes.begin(), sizes.end()), 200U);
  // Squares of 16 x 16 cut 6 x 127 edges.
  EXPECT_LE(cut_weight(graph, partition), kMeshEdge * 762 * 11 / 10);
}

TEST(Kway, CutsNoEdgesIfComponentsAreParts) {
  PartitionScene scene;
  for (int i = 0; i < 6; ++i) scene.add_grid(10, 10, {200.0 * i, 0, 0});
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  const Partition partition = kway_partition(graph, 6);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(parts_of(std::span(partition).subspan(100 * i, 100)).size(), 1U) << i;
  }
  EXPECT_EQ(part_sizes(partition), std::vector<std::uint32_t>(6, 100));
}

TEST(Kway, GivesEachPartAVertex) {
  PartitionScene scene;
  scene.add_grid(11, 7);
  const Graph graph = make_mesh_graph(scene.points, scene.triangles);
  for (const std::uint32_t count : {1U, 13U, 50U, 76U, 77U}) {
    const auto sizes = part_sizes(kway_partition(graph, count));
    EXPECT_EQ(sizes.size(), count);
    EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 0U), 0) << count;
  }
}

}  // namespace
}  // namespace rlpc
