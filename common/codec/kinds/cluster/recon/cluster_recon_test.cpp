#include "common/codec/kinds/cluster/recon/cluster_recon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "common/testing/residual_bound.h"

namespace rlpc {
namespace {

using Positions = std::vector<std::int32_t>;

constexpr int kUnitScale = 32;  // scale_idx of scale 1

SequenceHeader header_of(std::uint32_t num_vertices, int position_bits = 20) {
  SequenceHeader header;
  header.num_vertices = num_vertices;
  header.position_bits = position_bits;
  return header;
}

ClusterGof world_gof(std::uint32_t num_vertices, std::uint32_t num_frames) {
  ClusterGof gof;
  gof.num_frames = num_frames;
  gof.clusters.resize(1);
  gof.cluster_of_vertex.assign(num_vertices, 0);
  return gof;
}

// Spatial values have 13 bits or more: they are not normalised, and products are in 1/16 grid
// steps.
Component component_of(std::vector<std::int32_t> temporal, std::vector<std::int32_t> spatial) {
  Component component;
  component.scale_idx = kUnitScale;
  component.temporal_bits = 20;
  component.spatial_bits = 20;
  component.temporal_residual = std::move(temporal);
  component.spatial_residual = std::move(spatial);
  return component;
}

Positions frame_of(const SequenceHeader& header, const ClusterGof& gof, std::uint32_t f,
                   const std::vector<Triangle>& triangles = {}) {
  const Topology topology = make_topology(header.num_vertices, triangles);
  const ClusterRecon recon(header, topology, gof);
  EXPECT_EQ(recon.num_frames(), gof.num_frames);
  Positions positions(3 * std::size_t{header.num_vertices}, 77777);
  recon.frame(f, positions);
  return positions;
}

TEST(ClusterRecon, WorldPositionsAreRoundedSumsOfProducts) {
  ClusterGof gof = world_gof(2, 3);
  gof.clusters[0].components = {
      component_of({1, 2, -1}, {160, -24, /* y */ 8, 7, /* z */ -8, -9}),
      component_of({0, 1, 1}, {16, 32, 48, 64, 80, 96}),
  };
  EXPECT_EQ(frame_of(header_of(2), gof, 0), (Positions{10, 1, 0, -1, 0, -1}));
  EXPECT_EQ(frame_of(header_of(2), gof, 1), (Positions{21, 4, 4, -1, 5, 5}));
  EXPECT_EQ(frame_of(header_of(2), gof, 2), (Positions{-9, 3, 6, 4, 4, 7}));
}

TEST(ClusterRecon, FractionBitsAreRoundedAwayBeforeTheLocalUnit) {
  ClusterGof gof = world_gof(1, 1);
  gof.fraction_bits = 3;
  // 60 / 8 = 7.5, up to 8, then 8 / 16, up to 1; 59 / 8 is rounded to 7, then down to 0.
  gof.clusters[0].components = {component_of({1}, {60, 59, -68})};
  EXPECT_EQ(frame_of(header_of(1), gof, 0), (Positions{1, 0, 0}));
}

TEST(ClusterRecon, SpatialValuesOfFewBitsAreShiftedUpTo13) {
  ClusterGof gof = world_gof(1, 1);
  Component component = component_of({16}, {1, -2, 0});
  component.spatial_bits = 2;
  gof.clusters[0].components = {component};
  EXPECT_EQ(frame_of(header_of(1), gof, 0), (Positions{2048, -4096, 0}));
}

TEST(ClusterRecon, ScaleMultipliesTheTemporalValues) {
  ClusterGof gof = world_gof(1, 1);
  gof.clusters[0].components = {component_of({100}, {16, 32, -16})};
  gof.clusters[0].components[0].scale_idx = kUnitScale + 8;
  EXPECT_EQ(frame_of(header_of(1), gof, 0), (Positions{200, 400, -200}));
  gof.clusters[0].components[0].scale_idx = kUnitScale + 4;  // 141.4
  EXPECT_EQ(frame_of(header_of(1), gof, 0), (Positions{141, 282, -141}));
  gof.clusters[0].components[0].temporal_bits = 7;  // at most 63
  EXPECT_EQ(frame_of(header_of(1), gof, 0), (Positions{63, 126, -63}));
}

TEST(ClusterRecon, TemporalValuesArePredictedAndClippedTo24Bits) {
  Component component = component_of({100, 10, 10, -5}, {});
  component.temporal_predictor = 1;
  EXPECT_EQ(recon_temporal(component), (std::vector<std::int32_t>{100, 110, 120, 115}));
  component.temporal_predictor = 2;
  EXPECT_EQ(recon_temporal(component), (std::vector<std::int32_t>{100, 110, 130, 145}));
  component.temporal_predictor = 0;
  EXPECT_EQ(recon_temporal(component), component.temporal_residual);
  const std::int32_t max_value = (1 << 23) - 1;
  component =
      component_of({kResidualBound, 1, -kResidualBound, -kResidualBound, kResidualBound}, {});
  component.temporal_predictor = 4;
  const std::vector<std::int32_t> values = recon_temporal(component);
  EXPECT_EQ(values[0], max_value);
  EXPECT_EQ(values[1], max_value);
  EXPECT_EQ(values[2], -max_value - 1);
  EXPECT_EQ(values[3], -max_value - 1);
}

// Square of two triangles.
struct Square {
  Topology topology = make_topology(4, std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}});
  std::vector<std::uint32_t> vertices{0, 1, 2, 3};
  std::vector<std::uint16_t> cluster_of_vertex{0, 0, 0, 0};
  std::vector<std::uint32_t> local_index{0, 1, 2, 3};

  std::vector<std::int32_t> values(SpatialPredictor predictor, std::vector<std::int32_t> x,
                                   int spatial_bits = 20) const {
    Component component = component_of({}, std::move(x));
    component.spatial_bits = spatial_bits;
    component.spatial_predictor = predictor;
    component.spatial_residual.resize(3 * vertices.size());
    std::vector<std::int32_t> all = recon_spatial(
        component, SpatialPrediction(topology, vertices, cluster_of_vertex, local_index));
    EXPECT_EQ(
        std::vector<std::int32_t>(all.begin() + static_cast<long>(vertices.size()), all.end()),
        std::vector<std::int32_t>(2 * vertices.size(), 0));  // y and z: independent of x
    all.resize(vertices.size());
    return all;
  }
};

using Values = std::vector<std::int32_t>;

TEST(SpatialValues, AreTheResidualsWithoutPredictor) {
  EXPECT_EQ(Square().values(SpatialPredictor::kNone, {10, 4, -3, 7}), (Values{10, 4, -3, 7}));
}

TEST(SpatialValues, NeighboursPredictTheirMean) {
  // 0: not predicted; 1: from 0; 2: from 0 and 1, (10 + 14) / 2; 3: from 1 and 2, (14 + 9) / 2,
  // rounded up
  EXPECT_EQ(Square().values(SpatialPredictor::kNeighbours, {10, 4, -3, 7}),
            (Values{10, 14, 9, 19}));
}

TEST(SpatialValues, ParallelogramsPredictIfThereIsOne) {
  // 3: 14 + 9 - 10
  EXPECT_EQ(Square().values(SpatialPredictor::kParallelogram, {10, 4, -3, 7}),
            (Values{10, 14, 9, 20}));
}

TEST(SpatialValues, AreClippedToTheirWidth) {
  EXPECT_EQ(Square().values(SpatialPredictor::kParallelogram, {100, 4, -300, 7}, 5),
            (Values{15, 15, -16, -9}));
}

TEST(SpatialValues, ArePredictedOnlyFromTheSameCluster) {
  Square square;
  square.vertices = {0, 2, 3};
  square.cluster_of_vertex = {0, kSeedCluster, 0, 0};
  square.local_index = {0, 99, 1, 2};
  // 2: from 0 alone; 3: no parallelogram without vertex 1, from 2 alone
  EXPECT_EQ(square.values(SpatialPredictor::kParallelogram, {10, 4, 7}), (Values{10, 14, 21}));
  square.vertices = {0, 3};
  square.cluster_of_vertex = {0, 1, 1, 0};
  square.local_index = {0, 0, 1, 1};
  // 3 has no neighbour in the cluster: predicted from the previous vertex
  EXPECT_EQ(square.values(SpatialPredictor::kNeighbours, {10, 4}), (Values{10, 14}));
}

TEST(ClusterRecon, PositionsAreClippedToPositionBits) {
  ClusterGof gof = world_gof(2, 2);
  gof.clusters[0].components = {
      component_of({1, 1 << 18}, {16 * 7, 16 * 8, 16 * -8, -16 * 9, 0, 16})};
  EXPECT_EQ(frame_of(header_of(2, 4), gof, 0), (Positions{7, -8, 0, 7, -8, 1}));
  EXPECT_EQ(frame_of(header_of(2, 4), gof, 1), (Positions{7, -8, 0, 7, -8, 7}));
  EXPECT_EQ(frame_of(header_of(2, 24), gof, 1),
            (Positions{7 << 18, -8 * (1 << 18), 0, 1 << 21, -9 * (1 << 18), 1 << 18}));
}

// The seeds are vertices 3, 1 and 0 of five; vertices 2 and 4 are coded.
ClusterGof lcf_gof(std::uint32_t num_frames) {
  ClusterGof gof = world_gof(5, num_frames);
  gof.clusters[0].lcf_flag = true;
  gof.clusters[0].seed_vertex = {3, 1, 0};
  gof.seed_predictor = 0;
  gof.seed_tracks = {{3, 0, {}}, {1, 0, {}}, {0, 0, {}}};
  gof.cluster_of_vertex = {kSeedCluster, kSeedCluster, 0, kSeedCluster, 0};
  return gof;
}

TEST(ClusterRecon, LocalCoordinatesMoveWithTheSeeds) {
  ClusterGof gof = lcf_gof(2);
  // Frame 0: axes of the world, origin (5, 0, 0). Residuals of frame 0 are against track 0.
  // Frame 1: x to z, y to x, z to y of the world, origin (100, 200, 305).
  gof.seed_tracks[0].residual = {{0, 0, 0}, {100, 200, 300}};
  gof.seed_tracks[1].residual = {{10, 0, 0}, {100, 200, 310}};
  gof.seed_tracks[2].residual = {{0, 10, 0}, {110, 200, 300}};
  gof.clusters[0].components = {component_of({1, 1}, {16, -32, /* y */ 48, 0, /* z */ 0, 64})};
  EXPECT_EQ(frame_of(header_of(5), gof, 0),
            (Positions{0, 10, 0, 10, 0, 0, 6, 3, 0, 0, 0, 0, 3, 0, 4}));
  EXPECT_EQ(frame_of(header_of(5), gof, 1), (Positions{110, 200, 300, 100, 200, 310, 103, 200,
                                                       306, 100, 200, 300, 100, 204, 303}));
}

TEST(ClusterRecon, HandsOverItsClustersAsBones) {
  ClusterGof gof = lcf_gof(2);
  gof.clusters.resize(2);  // the second one is in world coordinates
  gof.cluster_of_vertex[4] = 1;
  gof.seed_step = 3;
  gof.seed_tracks[0].residual = {{0, 0, 0}, {0, 0, 0}};
  gof.seed_tracks[1].residual = {{10, 0, 0}, {0, 0, 10}};
  gof.seed_tracks[2].residual = {{0, 10, 0}, {10, 0, 0}};
  const ClusterRecon recon(header_of(5), make_topology(5, {}), gof);
  const Skeleton skeleton = recon.skeleton();
  const std::vector<SkeletonInfluence> first{{0, 1}};
  const std::vector<SkeletonInfluence> second{{1, 1}};
  EXPECT_EQ(skeleton.influences, (std::vector{first, first, first, first, second}));
  EXPECT_EQ(skeleton.step, 48U);
  constexpr std::int64_t kOne = std::int64_t{1} << 30;
  const std::array<Vec3l, 3> world{{{kOne, 0, 0}, {0, kOne, 0}, {0, 0, kOne}}};
  ASSERT_EQ(skeleton.bones.size(), 2U);
  EXPECT_EQ(skeleton.bones[0].bind, (BonePlace{world, {240, 0, 0}}));
  EXPECT_EQ(skeleton.bones[1].bind, (BonePlace{world, {0, 0, 0}}));
  // x to z, y to x, z to y
  const std::array<Vec3l, 3> turned{{{0, 0, kOne}, {kOne, 0, 0}, {0, kOne, 0}}};
  EXPECT_EQ(recon.places(1)[0], (BonePlace{turned, {0, 0, 240}}));
  EXPECT_EQ(recon.places(1)[1], (BonePlace{world, {0, 0, 0}}));
}

TEST(ClusterRecon, VerticesAreAtTheOriginWithoutComponents) {
  EXPECT_EQ(frame_of(header_of(2), world_gof(2, 1), 0), Positions(6, 0));
  ClusterGof gof = lcf_gof(1);
  gof.seed_tracks[0].residual = {{4, 6, 8}};
  gof.seed_tracks[1].residual = {{10, 0, 0}};
  gof.seed_tracks[2].residual = {{0, 10, 0}};
  EXPECT_EQ(frame_of(header_of(5), gof, 0),
            (Positions{4, 16, 8, 14, 6, 8, 9, 6, 8, 4, 6, 8, 9, 6, 8}));
}

TEST(ClusterRecon, ClustersShareSeedsAndMayBeEmpty) {
  ClusterGof gof = lcf_gof(1);
  gof.clusters.resize(3);
  gof.clusters[1] = gof.clusters[0];
  gof.clusters[1].seed_vertex = {1, 3, 0};  // the same seeds, x reversed
  gof.cluster_of_vertex[4] = 1;             // cluster 2 is empty
  gof.seed_tracks[0].residual = {{0, 0, 0}};
  gof.seed_tracks[1].residual = {{10, 0, 0}};
  gof.seed_tracks[2].residual = {{0, 10, 0}};
  gof.clusters[0].components = {component_of({1}, {16, 32, 48})};
  gof.clusters[1].components = gof.clusters[0].components;
  gof.clusters[2].components = {component_of({1}, {})};
  // Cluster 1: x is -x of the world, z is -z, so y is y.
  EXPECT_EQ(frame_of(header_of(5), gof, 0),
            (Positions{0, 10, 0, 10, 0, 0, 6, 2, 3, 0, 0, 0, 4, 2, -3}));
}

TEST(ClusterRecon, CombinesWorldAndLocalClusters) {
  ClusterGof gof = lcf_gof(1);
  gof.clusters.resize(2);
  gof.cluster_of_vertex[4] = 1;
  gof.seed_tracks[0].residual = {{100, 0, 0}};
  gof.seed_tracks[1].residual = {{10, 0, 0}};
  gof.seed_tracks[2].residual = {{0, 10, 0}};
  gof.clusters[0].components = {component_of({1}, {16, 0, 0})};
  gof.clusters[1].components = {component_of({1}, {16, 0, 0})};
  const Positions positions = frame_of(header_of(5), gof, 0);
  EXPECT_EQ(positions[6], 106);
  EXPECT_EQ(positions[12], 1);
}

// Factors and seeds at their bounds: sums of 2^48, local coordinates clipped to 31 bits.
TEST(ClusterRecon, SaturatingInputsAreClippedNotWrapped) {
  ClusterGof gof = lcf_gof(1);
  gof.seed_step = kMaxSeedStep;
  for (SeedTrack& track : gof.seed_tracks)
    track.residual = {{kResidualBound, -kResidualBound, kResidualBound}};
  gof.seed_tracks[1].residual = {{-kResidualBound, 0, 0}};
  Component component = component_of({-(1 << 23)}, {});
  component.scale_idx = kMaxScaleIdx;
  component.temporal_bits = kMaxTemporalBits;
  component.spatial_bits = kMaxSpatialBits;
  component.spatial_residual = {-kResidualBound, kResidualBound,  kResidualBound,
                                kResidualBound,  -kResidualBound, kResidualBound};
  gof.clusters[0].components.assign(3, component);
  const std::int32_t max_value = (1 << 23) - 1;
  const Positions positions = frame_of(header_of(5, 24), gof, 0);
  EXPECT_EQ((Positions{positions.begin() + 9, positions.begin() + 12}),
            (Positions{max_value, -max_value - 1, max_value}));  // seed 3
  for (const std::int32_t x : positions) {
    EXPECT_GE(x, -max_value - 1);
    EXPECT_LE(x, max_value);
  }
  gof.clusters[0].lcf_flag = false;
  EXPECT_EQ((Positions{frame_of(header_of(5, 24), gof, 0)[6]}), Positions{max_value});
}

// Several frames at a time; clusters with and without a local frame, of more than a tile.
TEST(ClusterRecon, ReconstructsFramesTogetherLikeSingleOnes) {
  constexpr std::uint32_t kVertices = 60;
  ClusterGof gof = world_gof(kVertices, 7);
  gof.fraction_bits = 3;
  gof.clusters.resize(2);
  gof.clusters[1].lcf_flag = true;
  gof.clusters[1].seed_vertex = {0, 1, 2};
  for (std::uint32_t v = 0; v < kVertices; ++v) gof.cluster_of_vertex[v] = v % 2 == 0 ? 1 : 0;
  std::mt19937 random(1);
  const auto numbers = [&](std::size_t count) {
    std::vector<std::int32_t> list(count);
    for (std::int32_t& x : list) x = static_cast<std::int32_t>(random() % 2000) - 1000;
    return list;
  };
  for (std::uint32_t v = 0; v < 3; ++v) {
    gof.cluster_of_vertex[v] = kSeedCluster;
    gof.seed_tracks.push_back({v, 0, {}});
    for (std::uint32_t f = 0; f < gof.num_frames; ++f) {
      const auto x = numbers(3);
      gof.seed_tracks.back().residual.push_back({x[0], x[1], x[2]});
    }
  }
  const ClusterMembers members = cluster_members(gof);
  for (std::size_t i = 0; i < 2; ++i) {
    gof.clusters[i].components = {
        component_of(numbers(gof.num_frames), numbers(3 * members.vertices[i].size())),
        component_of(numbers(gof.num_frames), numbers(3 * members.vertices[i].size()))};
  }
  const Topology topology = make_topology(kVertices, {});
  const ClusterRecon recon(header_of(kVertices), topology, gof);
  constexpr std::size_t kSize = 3 * kVertices;
  for (std::uint32_t first = 0; first < gof.num_frames; ++first) {
    for (std::uint32_t count = 1; first + count <= gof.num_frames; ++count) {
      Positions together(count * kSize, 77777);
      recon.frames(first, count, together);
      for (std::uint32_t f = 0; f < count; ++f) {
        Positions alone(kSize, 77777);
        recon.frame(first + f, alone);
        EXPECT_TRUE(std::equal(alone.begin(), alone.end(), together.begin() + f * kSize))
            << first << ' ' << f;
      }
    }
  }
}

TEST(ClusterRecon, ReconstructsFramesInAnyOrder) {
  ClusterGof gof = world_gof(2, 4);
  gof.clusters[0].components = {component_of({10, 5, -3, 8}, {160, 32, 16, -48, 64, 16})};
  gof.clusters[0].components[0].temporal_predictor = 2;
  const Topology topology = make_topology(2, {});
  const SequenceHeader header = header_of(2);
  const ClusterRecon recon(header, topology, gof);
  std::vector<Positions> forwards(4, Positions(6));
  for (std::uint32_t f = 0; f < 4; ++f) recon.frame(f, forwards[f]);
  for (const std::uint32_t f : {3U, 0U, 2U, 2U, 1U}) {
    Positions again(6);
    recon.frame(f, again);
    EXPECT_EQ(again, forwards[f]);
  }
}

}  // namespace
}  // namespace rlpc
