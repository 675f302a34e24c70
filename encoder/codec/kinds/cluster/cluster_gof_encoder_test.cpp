#include "encoder/codec/kinds/cluster/cluster_gof_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/codec/bits/residual_models.h"
#include "common/codec/kinds/cluster/recon/seed_tracks.h"

namespace rlpc {
namespace {

constexpr double kTurn = 6.283185307179586;

// A bending strip of squares, in grid steps.
struct Strip {
  static constexpr std::uint32_t kColumns = 20;
  SequenceHeader header;
  std::vector<Triangle> triangles;
  Topology topology;
  SpanFrames frames;

  explicit Strip(std::uint32_t num_frames) {
    for (std::uint32_t i = 0; i + 1 < kColumns; ++i) {
      triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
      triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
    }
    header.num_vertices = frames.num_vertices = 2 * kColumns;
    header.num_triangles = static_cast<std::uint32_t>(triangles.size());
    header.num_frames = frames.num_frames = num_frames;
    header.position_bits = 20;
    topology = make_topology(header.num_vertices, triangles);
    for (std::uint32_t f = 0; f < num_frames; ++f) {
      for (std::uint32_t v = 0; v < header.num_vertices; ++v) {
        const double along = v >> 1;
        const double bend = 3000.0 * std::sin(kTurn * (f / 12.0 + along / 30.0));
        frames.xyz.insert(frames.xyz.end(),
                          {1000.0 * along, 900.0 * (v % 2) + 0.1 * bend, bend});
      }
    }
  }
  SequenceMesh mesh() const { return {header, topology, triangles}; }
  Clustering halves() const {
    Clustering clustering{{{0, 2, 1}, {38, 36, 39}}, {}};
    for (std::uint32_t v = 0; v < header.num_vertices; ++v) {
      clustering.cluster_of_vertex.push_back(v < kColumns ? 0 : 1);
    }
    return clustering;
  }
  // Returns the RMS error over all coordinates and frames.
  double error_of(const ClusterGof& gof) const {
    const ClusterRecon recon(header, topology, gof);
    std::vector<std::int32_t> positions(3 * std::size_t{header.num_vertices});
    double sum = 0.0;
    for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
      recon.frame(f, positions);
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const double d = positions[i] - frames.at(f, 0)[i];
        sum += d * d;
      }
    }
    return std::sqrt(sum / static_cast<double>(frames.xyz.size()));
  }
};

TEST(AnalyseGof, SeedsAreRecoveredToHalfASeedStep) {
  const Strip strip(30);
  for (const std::uint32_t seed_step : {1U, 2U, 7U, 100U}) {
    ClusterAnalysisSettings settings;
    settings.seed_step = seed_step;
    const ClusterGofAnalysis analysis =
        analyse_cluster_gof(strip.mesh(), strip.frames, strip.halves(), settings);
    const std::vector<Track> tracks = recon_seed_tracks(analysis.gof, 20);
    ASSERT_EQ(tracks.size(), 6U);
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      for (std::uint32_t f = 0; f < 30; ++f) {
        const double* original = strip.frames.at(f, analysis.gof.seed_tracks[t].vertex);
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_LE(std::abs(tracks[t][f][c] - original[c]), 0.5 + 0.5 * seed_step);
        }
      }
    }
  }
}

TEST(AnalyseGof, SharedSeedsHaveOneTrackAndSeedsAreInNoCluster) {
  const Strip strip(3);
  Clustering clustering = strip.halves();
  clustering.seeds = {{0, 2, 1}, {2, 4, 1}};
  const ClusterGof gof = analyse_cluster_gof(strip.mesh(), strip.frames, clustering, {}).gof;
  ASSERT_EQ(gof.seed_tracks.size(), 4U);
  const std::vector<std::uint32_t> vertices{0, 2, 1, 4};
  const std::vector<std::uint32_t> anchors{0, 0, 0, 1};
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_EQ(gof.seed_tracks[t].vertex, vertices[t]);
    EXPECT_EQ(gof.seed_tracks[t].anchor, anchors[t]);
    EXPECT_EQ(gof.cluster_of_vertex[vertices[t]], kSeedCluster);
  }
}

// Fast, smooth motion across the whole grid, for which the highest predictor order is best. Two
// frames in between jump from one end of the grid to the other, which this predictor amplifies
// almost sixfold.
TEST(AnalyseGof, SeedResidualsStayWithinTheirBounds) {
  constexpr std::uint32_t kFrames = 1000;
  Strip strip(1);
  strip.header.position_bits = 24;
  strip.header.num_frames = strip.frames.num_frames = kFrames;
  strip.header.num_vertices = strip.frames.num_vertices = 3;
  strip.triangles = {{0, 1, 2}};
  strip.topology = make_topology(3, strip.triangles);
  strip.frames.xyz.clear();
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    const double turn = kTurn * f / 20.0;
    for (std::uint32_t v = 0; v < 3; ++v) {
      double x = 4e6 * std::sin(turn) + (v == 1 ? 4e6 : 0.0);
      if (v == 0 && f == 500) x = 8388607.0;
      if (v == 0 && f == 501) x = -8388608.0;
      strip.frames.xyz.insert(
          strip.frames.xyz.end(),
          {x, 4e6 * std::cos(turn) + (v == 2 ? 4e6 : 0.0), 4e6 * std::sin(turn + 1.0)});
    }
  }
  const Clustering clustering{{{0, 1, 2}}, {0, 0, 0}};
  const ClusterGof gof = analyse_cluster_gof(strip.mesh(), strip.frames, clustering, {}).gof;
  for (const SeedTrack& track : gof.seed_tracks) {
    for (const Vec3i& r : track.residual) {
      for (const std::int32_t x : r) ASSERT_LE(magnitude_of(x), kMaxResidual);
    }
  }
}

TEST(CodeGof, ErrorFollowsTheStep) {
  const Strip strip(40);
  for (const bool world : {false, true}) {
    ClusterAnalysisSettings settings;
    settings.world = world;
    const ClusterGofAnalysis analysis =
        analyse_cluster_gof(strip.mesh(), strip.frames, strip.halves(), settings);
    for (const double step : {4.0, 16.0, 64.0}) {
      ClusterCodingSettings coding;
      coding.step = step;
      const double error = strip.error_of(code_cluster_gof(strip.frames, analysis, coding));
      EXPECT_LT(error, 0.75 * step) << world;
      EXPECT_GT(error, 0.02 * step) << world;
    }
  }
}

TEST(CodeGof, FixedAllocationTakesTheRequestedComponentsIfTheyExist) {
  const Strip strip(10);
  const ClusterGofAnalysis analysis =
      analyse_cluster_gof(strip.mesh(), strip.frames, strip.halves(), {});
  for (const std::uint32_t count : {0U, 1U, 3U, 500U}) {
    ClusterCodingSettings coding;
    coding.allocation = ClusterCodingSettings::Allocation::kFixed;
    coding.components = count;
    const ClusterGof gof = code_cluster_gof(strip.frames, analysis, coding);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(gof.clusters[i].components.size(),
                std::min<std::size_t>(count, analysis.clusters[i].pc.spatial.size()));
    }
  }
}

TEST(CodeGof, AVectorBudgetIsSharedByTheClusters) {
  const Strip strip(30);
  const ClusterGofAnalysis analysis =
      analyse_cluster_gof(strip.mesh(), strip.frames, strip.halves(), {});
  ClusterCodingSettings coding;
  coding.allocation = ClusterCodingSettings::Allocation::kVectorBudget;
  coding.components = 2;
  std::size_t sum = 0;
  for (const Cluster& cluster : code_cluster_gof(strip.frames, analysis, coding).clusters) {
    sum += cluster.components.size();
  }
  EXPECT_LE(sum, 4U);
  EXPECT_GE(sum, 1U);
}

}  // namespace
}  // namespace rlpc
