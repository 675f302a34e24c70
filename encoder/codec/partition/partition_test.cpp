#include "encoder/codec/partition/partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "common/parallel/for_each.h"
#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

constexpr std::array kMethods{PartitionMethod::kKway, PartitionMethod::kLloyd,
                              PartitionMethod::kSpectral, PartitionMethod::kMotion};

class PartitionMethods : public testing::TestWithParam<PartitionMethod> {
 protected:
  // Checks what every partition promises.
  Partition partition(const SpanFrames& frames, std::span<const Triangle> triangles,
                      std::uint32_t count) const {
    Partition parts = partition_vertices(GetParam(), frames, triangles, count);
    EXPECT_EQ(parts.size(), frames.num_vertices);
    std::uint32_t next = 0;
    for (const std::uint16_t part : parts) {
      EXPECT_LE(part, next);
      next = std::max(next, part + 1U);
    }
    EXPECT_GE(next, 1U);
    EXPECT_LE(next, std::min(count, frames.num_vertices));
    EXPECT_EQ(num_parts(parts), next);
    return parts;
  }
};

// Bends and shakes the points.
SpanFrames shaken(const PartitionScene& scene, std::uint32_t num_frames) {
  std::minstd_rand random(3);
  return scene.frames(num_frames, [&](std::uint32_t f, std::uint32_t v) {
    Point3 p = scene.points[v];
    p[2] += 0.01 * f * p[0] * p[0];
    for (double& c : p) c += static_cast<double>(random() % 1000) / 500.0;
    return p;
  });
}

TEST_P(PartitionMethods, DivideAGridIntoAsManyPartsAsAsked) {
  PartitionScene scene;
  scene.add_grid(20, 15);
  const SpanFrames frames = shaken(scene, 5);
  for (const std::uint32_t count : {1U, 2U, 3U, 8U, 31U}) {
    EXPECT_EQ(num_parts(partition(frames, scene.triangles, count)), count);
  }
}

TEST_P(PartitionMethods, DivideAPointCloud) {
  PartitionScene scene;
  scene.add_grid(20, 15);
  EXPECT_EQ(num_parts(partition(shaken(scene, 4), {}, 6)), 6U);
}

TEST_P(PartitionMethods, DivideManyComponents) {
  PartitionScene scene;
  for (int i = 0; i < 40; ++i) scene.add_grid(3, 3, {70.0 * i, 13.0 * (i % 3), 5.0 * i});
  scene.points.push_back({0, 500, 0});  // isolated
  EXPECT_EQ(num_parts(partition(shaken(scene, 4), scene.triangles, 7)), 7U);
}

TEST_P(PartitionMethods, GiveAtMostOnePartToEachVertex) {
  PartitionScene scene;
  scene.add_grid(3, 2);
  for (const std::uint32_t count : {6U, 7U, kMaxParts}) {
    partition(shaken(scene, 3), scene.triangles, count);
    partition(shaken(scene, 3), {}, count);
  }
  scene.points.resize(1);
  EXPECT_EQ(partition(shaken(scene, 3), {}, 5), Partition{0});
  EXPECT_EQ(partition(scene.still(), {}, 1), Partition{0});
}

TEST_P(PartitionMethods, TakePointsThatCoincide) {
  PartitionScene scene;
  scene.points.assign(300, Point3{5, 5, 5});
  partition(scene.still(), {}, 4);
  partition(shaken(scene, 1), {}, 4);
  for (std::uint32_t v = 2; v < 300; ++v) scene.triangles.push_back({0, v - 1, v});  // a fan
  partition(scene.still(), scene.triangles, 4);
  scene.triangles.push_back({7, 7, 7});
  partition(scene.still(), scene.triangles, 4);
}

TEST_P(PartitionMethods, TakeTheMostParts) {
  PartitionScene scene;
  scene.add_grid(60, 50);
  EXPECT_GT(num_parts(partition(shaken(scene, 3), scene.triangles, kMaxParts)), 512U);
}

TEST_P(PartitionMethods, DoNotDependOnThreads) {
  PartitionScene scene;
  scene.add_grid(70, 60);  // several ranges of vertices
  const SpanFrames frames = shaken(scene, 4);
  const Partition alone = partition(frames, scene.triangles, 9);
  const Threads threads(3);
  EXPECT_EQ(partition(frames, scene.triangles, 9), alone);
}

INSTANTIATE_TEST_SUITE_P(All, PartitionMethods, testing::ValuesIn(kMethods));

TEST(NumberParts, ByTheirLowestVertices) {
  Partition partition{7, 2, 7, 1023, 2, 0};
  number_parts(partition);
  EXPECT_EQ(partition, (Partition{0, 1, 0, 2, 1, 3}));
}

TEST(PartitionByMotion, IsByPositionsIfThereIsOneFrame) {
  PartitionScene scene;
  scene.add_grid(20, 15);
  const SpanFrames frames = scene.still();
  EXPECT_EQ(partition_vertices(PartitionMethod::kMotion, frames, scene.triangles, 5),
            partition_vertices(PartitionMethod::kLloyd, frames, scene.triangles, 5));
}

}  // namespace
}  // namespace rlpc
