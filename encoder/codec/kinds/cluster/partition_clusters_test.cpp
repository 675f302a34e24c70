#include "encoder/codec/kinds/cluster/partition_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <vector>

namespace rlpc {
namespace {

constexpr int kSheetBits = 20;  // position_bits
constexpr std::array kMethods{PartitionMethod::kKway, PartitionMethod::kLloyd,
                              PartitionMethod::kSpectral, PartitionMethod::kMotion};
constexpr std::uint32_t kColumns = 12;

struct Sheets {
  SpanFrames frames;
  std::vector<Triangle> triangles;
};

// Square sheets of 12 x 12 vertices that move apart; those of odd number are flattened to a
// line.
Sheets sheets(std::uint32_t count, bool some_are_lines) {
  Sheets scene;
  constexpr std::uint32_t kSheetVertices = kColumns * kColumns;
  scene.frames = {count * kSheetVertices, 4, {}};
  for (std::uint32_t f = 0; f < 4; ++f) {
    for (std::uint32_t v = 0; v < count * kSheetVertices; ++v) {
      const std::uint32_t sheet = v / kSheetVertices;
      const std::uint32_t row = v % kSheetVertices / kColumns;
      const double x = 10.0 * (v % kColumns);
      const double y = some_are_lines && sheet % 2 == 1 ? 0.0 : 10.0 * row;
      scene.frames.xyz.insert(scene.frames.xyz.end(),
                              {x + 1000.0 * sheet, y + 37.0 * (2 * sheet % 3) * f, 11.0 * f});
    }
  }
  for (std::uint32_t v = 0; v < count * kSheetVertices; ++v) {
    if (v % kColumns == 0 || v % kSheetVertices < kColumns) continue;
    scene.triangles.push_back({v - kColumns - 1, v - kColumns, v});
    scene.triangles.push_back({v - kColumns - 1, v, v - 1});
  }
  return scene;
}

class EachMethod : public testing::TestWithParam<PartitionMethod> {};
INSTANTIATE_TEST_SUITE_P(All, EachMethod, testing::ValuesIn(kMethods));

TEST_P(EachMethod, HasSeedsWithinTheParts) {
  const Sheets scene = sheets(3, false);
  PartitionClusters maker(GetParam(), scene.frames, scene.triangles, kSheetBits);
  for (const bool spread : {false, true}) {
    const Clustering clustering = spread ? maker.spread_clusters(3) : maker.clusters(3);
    ASSERT_EQ(clustering.seeds.size(), 3U);
    EXPECT_EQ(clustering.without_lcf, 0U);
    EXPECT_EQ(clustering.num_clusters(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const Seed& seed = clustering.seeds[i];
      EXPECT_EQ(std::set<std::uint32_t>(seed.begin(), seed.end()).size(), 3U);
      for (const std::uint32_t v : seed) EXPECT_EQ(clustering.cluster_of_vertex[v], i);
    }
    for (std::uint32_t v = 0; v < scene.frames.num_vertices; ++v) {
      EXPECT_EQ(clustering.cluster_of_vertex[v], clustering.cluster_of_vertex[v / 144 * 144]);
    }
  }
}

TEST(PartitionClusters, HaveSeedTrianglesNearTheCentreOrDistantVertices) {
  const Sheets scene = sheets(1, false);
  PartitionClusters maker(PartitionMethod::kLloyd, scene.frames, scene.triangles, kSheetBits);
  const Seed triangle = maker.clusters(1).seeds.at(0);
  for (const std::uint32_t v : triangle) {
    const std::uint32_t row = v / kColumns;
    EXPECT_NEAR(v % kColumns, 5.5, 2.6);
    EXPECT_NEAR(row, 5.5, 2.6);
  }
  const Seed distant = maker.spread_clusters(1).seeds.at(0);
  EXPECT_GE(distance2(scene.frames.at(0, distant[0]), scene.frames.at(0, distant[1])),
            50.0 * 50.0);
}

TEST(PartitionClusters, PutThoseWithoutASeedLast) {
  const Sheets scene = sheets(4, true);
  PartitionClusters maker(PartitionMethod::kLloyd, scene.frames, scene.triangles, kSheetBits);
  for (const bool spread : {false, true}) {
    const Clustering clustering = spread ? maker.spread_clusters(4) : maker.clusters(4);
    ASSERT_EQ(clustering.seeds.size(), 2U);
    EXPECT_EQ(clustering.without_lcf, 2U);
    EXPECT_EQ(clustering.num_clusters(), 4U);
    const auto cluster = [&](std::uint32_t sheet) {
      return clustering.cluster_of_vertex[sheet * kColumns * kColumns];
    };
    EXPECT_EQ(cluster(0), 0U);
    EXPECT_EQ(cluster(2), 1U);
    EXPECT_EQ(cluster(1), 2U);
    EXPECT_EQ(cluster(3), 3U);
  }
}

TEST(PartitionClusters, GiveTheSamePartsAgain) {
  const Sheets scene = sheets(2, false);
  PartitionClusters once(PartitionMethod::kKway, scene.frames, scene.triangles, kSheetBits);
  for (const std::uint32_t count : {5U, 2U, 5U}) {
    PartitionClusters other(PartitionMethod::kKway, scene.frames, scene.triangles, kSheetBits);
    const Clustering a = once.clusters(count);
    const Clustering b = other.clusters(count);
    EXPECT_EQ(a.seeds, b.seeds);
    EXPECT_EQ(a.cluster_of_vertex, b.cluster_of_vertex);
  }
}

TEST(PartitionClusters, OfOneVertex) {
  const SpanFrames frames{1, 2, {0, 0, 0, 1, 1, 1}};
  PartitionClusters maker(PartitionMethod::kMotion, frames, {}, kSheetBits);
  const Clustering clustering = maker.spread_clusters(8);
  EXPECT_TRUE(clustering.seeds.empty());
  EXPECT_EQ(clustering.num_clusters(), 1U);
  EXPECT_EQ(clustering.cluster_of_vertex, std::vector<std::uint16_t>{0});
}

}  // namespace
}  // namespace rlpc
