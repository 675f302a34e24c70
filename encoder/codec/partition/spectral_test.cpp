#include "encoder/codec/partition/spectral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/codec/partition/mesh_graph.h"
#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

Partition spectral(const PartitionScene& scene, std::uint32_t count) {
  return spectral_partition(make_mesh_graph(scene.points, scene.triangles), scene.points,
                            scene.triangles, count);
}

// A short side and a long one: equal parts would not meet at the fold.
TEST(Spectral, CutsAtAConcaveFold) {
  PartitionScene scene;
  scene.add_grid(40, 12);
  for (Point3& p : scene.points) p[2] = 2.0 * std::abs(p[0] - 100.0);
  const Partition partition = spectral(scene, 2);
  for (std::uint32_t v = 0; v < 480; ++v) {
    const std::uint32_t column = v % 40;
    if (column >= 9 && column <= 11) continue;
    EXPECT_EQ(partition[v], partition[column < 9 ? 0 : 39]) << v;
  }
  EXPECT_NE(partition[0], partition[39]);
}

// More vertices than samples.
TEST(Spectral, DividesALargeMeshAtItsFolds) {
  PartitionScene scene;
  scene.add_grid(120, 40);
  for (Point3& p : scene.points) {
    p[2] = p[0] < 300 ? -2 * p[0] : p[0] < 400 ? -600 : 2 * (p[0] - 400) - 600;
  }
  const Partition partition = spectral(scene, 2);
  EXPECT_EQ(parts_of(partition).size(), 2U);
  EXPECT_NE(partition[5], partition[100]);
  std::size_t wrong = 0;
  for (std::uint32_t v = 0; v < partition.size(); ++v) {
    if (v % 120 < 25) wrong += partition[v] != partition[5];
    if (v % 120 > 45) wrong += partition[v] != partition[100];
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(Spectral, TellsComponentsApart) {
  PartitionScene scene;
  for (int i = 0; i < 3; ++i) scene.add_grid(8, 8, {500.0 * i, 0, 0});
  const Partition partition = spectral(scene, 3);
  EXPECT_EQ(parts_of(partition).size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(parts_of(std::span(partition).subspan(64 * i, 64)).size(), 1U) << i;
  }
}

}  // namespace
}  // namespace rlpc
