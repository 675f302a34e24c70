#include "encoder/codec/partition/lloyd.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>

#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

TEST(Lloyd, DividesBySpaceAndNotByEdges) {
  PartitionScene scene;
  // Four sheets in two pairs; each joins the other pair only.
  for (const double x : {0.0, 1000.0, 5.0, 1005.0}) scene.add_grid(8, 8, {x, 0, 0});
  const Partition partition = lloyd_partition(scene.points, 2);
  EXPECT_EQ(parts_of(partition).size(), 2U);
  for (std::size_t v = 0; v < 128; ++v) {
    EXPECT_EQ(partition[v], partition[v / 64 * 64]) << v;
    EXPECT_EQ(partition[128 + v], partition[v]) << v;
  }
}

TEST(Lloyd, MakesPartsOfSimilarSize) {
  PartitionScene scene;
  scene.add_grid(40, 40);
  const auto sizes = part_sizes(lloyd_partition(scene.points, 4));
  ASSERT_EQ(sizes.size(), 4U);
  for (const std::uint32_t size : sizes) EXPECT_NEAR(size, 400, 40);
}

}  // namespace
}  // namespace rlpc
