#include "encoder/codec/partition/mesh_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "encoder/testing/partition_scenes.h"

namespace rlpc {
namespace {

SpanFrames rising(const PartitionScene& scene, std::uint32_t num_frames) {
  return scene.frames(num_frames, [&](std::uint32_t f, std::uint32_t v) {
    const Point3& p = scene.points[v];
    return Point3{p[0], p[1], p[2] + 1000.0 * f};
  });
}

// Returns the number of vertices of each component of the sample, ascending.
std::vector<std::size_t> components(const MeshSample& sample) {
  std::vector<std::uint32_t> root(sample.vertices.size());
  for (std::uint32_t v = 0; v < root.size(); ++v) root[v] = v;
  const auto lowest = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v];
    return v;
  };
  for (const Triangle& t : sample.triangles) {
    for (const std::uint32_t v : t) {
      const auto [low, high] = std::minmax({lowest(t[0]), lowest(v)});
      root[high] = low;
    }
  }
  std::vector<std::size_t> sizes(root.size(), 0);
  for (std::uint32_t v = 0; v < root.size(); ++v) ++sizes[lowest(v)];
  std::erase(sizes, 0U);
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

TEST(MeshSample, TakesAFewConnectedRegions) {
  PartitionScene scene;
  scene.add_grid(60, 50);
  const MeshSample sample = sample_mesh(scene.still(), scene.triangles, 300);
  EXPECT_EQ(sample.vertices.size(), 300U);
  EXPECT_TRUE(std::is_sorted(sample.vertices.begin(), sample.vertices.end()));
  EXPECT_EQ(std::set<std::uint32_t>(sample.vertices.begin(), sample.vertices.end()).size(),
            sample.vertices.size());
  std::size_t in_large = 0;
  for (const std::size_t size : components(sample)) in_large += size > 50 ? size : 0;
  EXPECT_GT(in_large, 280U);  // but for a vertex here and there at a border
}

TEST(MeshSample, TakesWholeComponentsWhereItCan) {
  PartitionScene scene;
  for (int i = 0; i < 40; ++i) scene.add_grid(8, 8, {100.0 * i, 0.0, 0.0});
  const MeshSample sample = sample_mesh(scene.still(), scene.triangles, 600);
  // Of at most 200 vertices, a region has two components: more than half of them.
  EXPECT_EQ(components(sample), std::vector<std::size_t>(6, 64));
}

TEST(MeshSample, TakesAllOfASmallMesh) {
  PartitionScene scene;
  scene.add_grid(5, 4);
  const MeshSample sample = sample_mesh(scene.still(), scene.triangles, 1000);
  EXPECT_EQ(sample.vertices.size(), 20U);
  EXPECT_EQ(sample.triangles, scene.triangles);
}

TEST(MeshSample, TakesPointsOfACloud) {
  PartitionScene scene;
  scene.add_grid(20, 20);
  scene.triangles.clear();
  const MeshSample sample = sample_mesh(scene.still(), {}, 60);
  EXPECT_GE(sample.vertices.size(), 30U);
  EXPECT_LE(sample.vertices.size(), 60U);
}

TEST(MeshSample, HasThePositionsOfItsVertices) {
  PartitionScene scene;
  scene.add_grid(30, 30);
  const SpanFrames frames = rising(scene, 5);
  const MeshSample sample = sample_mesh(frames, scene.triangles, 90);
  const SpanFrames part = sample.frames_of(frames, {2, 3});
  ASSERT_EQ(part.num_vertices, sample.vertices.size());
  ASSERT_EQ(part.num_frames, 3U);
  for (std::uint32_t f = 0; f < 3; ++f) {
    for (std::uint32_t v = 0; v < part.num_vertices; ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(part.at(f, v)[c], frames.at(f + 2, sample.vertices[v])[c]);
      }
    }
  }
  for (const Triangle& t : sample.triangles) {
    const Triangle whole{sample.vertices[t[0]], sample.vertices[t[1]], sample.vertices[t[2]]};
    EXPECT_NE(std::find(scene.triangles.begin(), scene.triangles.end(), whole),
              scene.triangles.end());
  }
}

}  // namespace
}  // namespace rlpc
