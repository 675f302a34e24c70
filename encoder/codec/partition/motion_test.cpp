#include "encoder/codec/partition/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/codec/partition/mesh_graph.h"
#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

Partition by_motion(const PartitionScene& scene, const SpanFrames& frames,
                    std::uint32_t count) {
  return motion_partition(frames, make_mesh_graph(scene.points, scene.triangles), count);
}

// Moves a sheet of 30 columns, of which the first and the last ten turn about column 10 and
// column 20.
Point3 hinged(const PartitionScene& scene, std::uint32_t f, std::uint32_t v) {
  Point3 p = scene.points[v];
  const double hinge = p[0] < 100 ? 100 : p[0] > 200 ? 200 : p[0];
  const double angle = 0.2 * f * (p[0] < 100 ? 1.0 : 2.0);
  const double x = p[0] - hinge;
  p[0] = hinge + x * std::cos(angle);
  p[2] = x * std::sin(angle);
  return p;
}

TEST(MotionPartition, FindsTheMovingParts) {
  PartitionScene scene;
  scene.add_grid(31, 8);
  const SpanFrames frames =
      scene.frames(6, [&](auto f, auto v) { return hinged(scene, f, v); });
  const Partition partition = by_motion(scene, frames, 3);
  EXPECT_EQ(parts_of(partition).size(), 3U);
  for (std::uint32_t v = 0; v < partition.size(); ++v) {
    const std::uint32_t column = v % 31;
    if (column == 10 || column == 20) continue;  // in both parts
    EXPECT_EQ(partition[v], partition[column < 10 ? 0 : column < 20 ? 15 : 30]) << v;
  }
}

TEST(MotionPartition, TellsPartsApartWhereverTheyAre) {
  PartitionScene scene;
  scene.add_grid(10, 10);
  scene.add_grid(10, 10, {5, 5, 5});  // among the first
  const SpanFrames frames = scene.frames(4, [&](std::uint32_t f, std::uint32_t v) {
    Point3 p = scene.points[v];
    p[v < 100 ? 0 : 1] += 10.0 * f;
    return p;
  });
  const Partition partition = by_motion(scene, frames, 2);
  EXPECT_NE(partition[0], partition[100]);
  EXPECT_EQ(parts_of(std::span(partition).first(100)).size(), 1U);
  EXPECT_EQ(parts_of(std::span(partition).last(100)).size(), 1U);
}

TEST(MotionPartition, HasOnePartIfNothingMoves) {
  PartitionScene scene;
  scene.add_grid(10, 10);
  const SpanFrames frames =
      scene.frames(5, [&](std::uint32_t /*f*/, std::uint32_t v) { return scene.points[v]; });
  EXPECT_EQ(parts_of(by_motion(scene, frames, 4)).size(), 1U);
}

// A triangle that follows no motion of its surroundings does not use up the parts.
TEST(MotionPartition, SurvivesOutliers) {
  PartitionScene scene;
  scene.add_grid(31, 8);
  const SpanFrames frames = scene.frames(6, [&](std::uint32_t f, std::uint32_t v) {
    Point3 p = hinged(scene, f, v);
    if (v == 77) p[1] += f % 2 == 0 ? 40.0 : -40.0;
    return p;
  });
  const Partition partition = by_motion(scene, frames, 6);
  EXPECT_NE(partition[0], partition[15]);
  EXPECT_NE(partition[30], partition[15]);
}

}  // namespace
}  // namespace rlpc
