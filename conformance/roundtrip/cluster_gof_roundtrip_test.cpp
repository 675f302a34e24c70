// Tests writer and parser of cluster GOFs against each other (clause 6.5), and reconstruction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/bits/residual_models.h"
#include "common/codec/kinds/cluster/recon/cluster_recon.h"
#include "common/testing/residual_bound.h"
#include "conformance/testing/ample_memory.h"
#include "conformance/testing/count_memory.h"
#include "decoder/codec/kinds/cluster/parse/parse_cluster_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "encoder/codec/write/write_cluster_gof.h"

namespace rlpc {
namespace {

constexpr int kResidualBits = floor_log2(kMaxResidual) + 1;  // bits of a magnitude

// Random legal GOFs. Fields take the ends of their ranges often.
class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  SequenceHeader header;
  Topology topology;

  ClusterGof gof(std::uint32_t max_vertices, std::uint32_t max_frames,
                 std::uint32_t max_clusters) {
    header.num_vertices = 1 + below(max_vertices);
    header.num_frames = 1 + below(1000);
    header.position_bits = between(kMinPositionBits, kMaxPositionBits);
    std::vector<Triangle> triangles(below(2 * header.num_vertices));
    for (Triangle& t : triangles) {
      const std::uint32_t near = below(header.num_vertices);
      for (std::uint32_t& v : t) v = std::min(near + below(5), header.num_vertices - 1);
    }
    header.num_triangles = static_cast<std::uint32_t>(triangles.size());
    topology = make_topology(header.num_vertices, triangles);

    ClusterGof gof;
    gof.first_frame = below(header.num_frames);
    gof.num_frames = 1 + below(std::min(max_frames, header.num_frames - gof.first_frame));
    gof.fraction_bits = between(0, kMaxFractionBits);
    gof.seed_step = static_cast<std::uint32_t>(between(1, static_cast<int>(kMaxSeedStep)));
    gof.seed_predictor = between(0, kMaxPredictorOrder);
    gof.seed_coupling_flag = coin();
    gof.clusters.resize(1 + below(max_clusters));
    gof.cluster_of_vertex.assign(header.num_vertices, 0);
    for (Cluster& cluster : gof.clusters) {
      if (header.num_vertices >= 3 && coin()) add_seeds(gof, cluster);
    }
    add_map(gof);
    for (SeedTrack& track : gof.seed_tracks) {
      track.residual.resize(gof.num_frames);
      const int bits = between(0, kResidualBits);
      for (Vec3i& r : track.residual) {
        for (std::int32_t& c : r) c = residual(bits);
      }
    }
    const ClusterMembers members = cluster_members(gof);
    for (std::size_t i = 0; i < gof.clusters.size(); ++i) {
      gof.clusters[i].components.resize(below(5));
      for (Component& c : gof.clusters[i].components) {
        fill(c, gof.num_frames, members.vertices[i].size());
      }
    }
    return gof;
  }

 private:
  std::uint32_t below(std::uint32_t n) {
    return n == 0 ? 0 : static_cast<std::uint32_t>(random_() % n);
  }
  bool coin() { return random_() % 2 == 0; }
  int between(int min, int max) {
    const auto kind = random_() % 6;
    if (kind == 0) return min;
    if (kind == 1) return max;
    return min + static_cast<int>(below(static_cast<std::uint32_t>(max - min + 1)));
  }
  std::int32_t residual(int bits) {
    if (random_() % 64 == 0) bits = kResidualBits;
    const auto range = std::uint32_t{1} << bits;
    const auto magnitude = static_cast<std::int32_t>(
        random_() % 32 == 0 ? range - 1 : static_cast<std::uint32_t>(random_()) % range);
    return coin() ? magnitude : -magnitude;
  }

  void add_seeds(ClusterGof& gof, Cluster& cluster) {
    cluster.lcf_flag = true;
    auto& s = cluster.seed_vertex;
    // Drawn from few vertices, so that clusters share them.
    const std::uint32_t range = std::min(header.num_vertices, coin() ? 4U : 1000000U);
    do {
      for (std::uint32_t& v : s) v = below(range);
    } while (s[0] == s[1] || s[1] == s[2] || s[2] == s[0]);
    std::uint32_t anchor = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t index = 0;
      while (index < gof.seed_tracks.size() && gof.seed_tracks[index].vertex != s[k]) ++index;
      if (k == 0) anchor = index;
      if (index == gof.seed_tracks.size()) gof.seed_tracks.push_back({s[k], anchor, {}});
      gof.cluster_of_vertex[s[k]] = kSeedCluster;
    }
  }

  // Runs of one cluster, so that predictions both hold and fail.
  void add_map(ClusterGof& gof) {
    std::uint16_t cluster = 0;
    for (std::uint16_t& c : gof.cluster_of_vertex) {
      if (random_() % 4 == 0) {
        cluster =
            static_cast<std::uint16_t>(below(static_cast<std::uint32_t>(gof.clusters.size())));
      }
      if (c != kSeedCluster) c = cluster;
    }
  }

  void fill(Component& c, std::uint32_t num_frames, std::size_t num_vertices) {
    c.scale_idx = between(0, kMaxScaleIdx);
    c.spatial_bits = between(1, kMaxSpatialBits);
    c.temporal_bits = between(1, kMaxTemporalBits);
    c.temporal_predictor = between(0, kMaxPredictorOrder);
    c.spatial_predictor = static_cast<SpatialPredictor>(between(0, kMaxSpatialPredictor));
    const int bits = between(0, kResidualBits);
    for (std::uint32_t f = 0; f < num_frames; ++f)
      c.temporal_residual.push_back(residual(bits));
    for (std::size_t i = 0; i < 3 * num_vertices; ++i) {
      c.spatial_residual.push_back(residual(std::min(bits, c.spatial_bits + 2)));
    }
  }

  std::mt19937 random_;
};

// Compares the parts first: they show where a difference is.
void expect_equal_clusters(const ClusterGof& a, const ClusterGof& b) {
  EXPECT_EQ(a.cluster_of_vertex, b.cluster_of_vertex);
  ASSERT_EQ(a.seed_tracks.size(), b.seed_tracks.size());
  for (std::size_t i = 0; i < a.seed_tracks.size(); ++i) {
    EXPECT_TRUE(a.seed_tracks[i] == b.seed_tracks[i]) << i;
  }
  ASSERT_EQ(a.clusters.size(), b.clusters.size());
  for (std::size_t i = 0; i < a.clusters.size(); ++i) {
    EXPECT_TRUE(a.clusters[i] == b.clusters[i]) << i;
  }
  EXPECT_TRUE(a == b);
}

void expect_cluster_round_trip(const Generator& from, const ClusterGof& gof) {
  const std::vector<std::uint8_t> payload = write_cluster_gof(gof, from.header, from.topology);
  BitReader r(payload);
  const GofHeader header = parse_gof_header(r, from.header, gof.first_frame);
  EXPECT_EQ(header.kind, GofKind::kCluster);
  const auto parsed = parse_clusters(r, from.header, from.topology, header, {kAmpleMemory, 0});
  ASSERT_TRUE(parsed) << parsed.error().rule << " " << parsed.error().element;
  expect_equal_clusters(gof, *parsed);

  const ClusterRecon written(from.header, from.topology, gof);
  const ClusterRecon read(from.header, from.topology, *parsed);
  const std::int32_t half = 1 << (from.header.position_bits - 1);
  std::vector<std::int32_t> a(3 * std::size_t{from.header.num_vertices}, 1 << 30);
  std::vector<std::int32_t> b = a;
  for (std::uint32_t f = 0; f < gof.num_frames; ++f) {
    written.frame(f, a);
    read.frame(f, b);
    ASSERT_EQ(a, b);
    for (const std::int32_t x : a) {
      ASSERT_GE(x, -half);
      ASSERT_LT(x, half);
    }
  }
}

TEST(ClusterGofRoundTrip, RandomLegalGofsComeBackAndReconstructAlike) {
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    Generator generator(seed);
    const ClusterGof gof = generator.gof(40, 8, 8);
    generator.header.profile_idc = seed % 2 == 0 ? kProfileMain : kProfileBaseline;
    expect_cluster_round_trip(generator, gof);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(ClusterGofRoundTrip, OneFrameAndOneVertexAreEnough) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Generator generator(seed);
    const ClusterGof gof = generator.gof(1, 1, 3);
    ASSERT_EQ(gof.num_frames, 1U);
    expect_cluster_round_trip(generator, gof);
  }
}

TEST(ClusterGofRoundTrip, AsManyClustersAsTheLevelAllowsComeBack) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Generator generator(seed);
    expect_cluster_round_trip(generator, generator.gof(500, 3, kLevels[0].max_clusters));
  }
}

TEST(ClusterGofRoundTrip, LongGofsOfFewVerticesComeBack) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Generator generator(seed);
    expect_cluster_round_trip(generator, generator.gof(6, kLevels[0].max_gof_frames, 3));
  }
}

// Alternating largest and smallest residuals drive every running mean to its limits.
TEST(ClusterGofRoundTrip, ResidualsThatJumpBetweenTheirBoundsComeBack) {
  Generator generator(1);
  ClusterGof gof = generator.gof(40, 8, 1);
  while (gof.seed_tracks.empty() || gof.num_frames < 4) gof = generator.gof(40, 8, 1);
  for (const int period : {1, 2, 7, 50}) {
    int count = 0;
    const auto next = [&] {
      ++count;
      return count / period % 2 == 0 ? 0 : count % 2 == 0 ? kResidualBound : -kResidualBound;
    };
    for (Vec3i& r : gof.seed_tracks[0].residual) r = {next(), next(), next()};
    gof.clusters[0].components.resize(3);
    for (Component& c : gof.clusters[0].components) {
      c.temporal_residual.resize(gof.num_frames);
      c.spatial_residual.resize(3 * cluster_members(gof).vertices[0].size());
      for (std::int32_t& x : c.temporal_residual) x = next();
      for (std::int32_t& x : c.spatial_residual) x = next();
    }
    expect_cluster_round_trip(generator, gof);
  }
}

// Returns the smallest max_memory_bytes with which the parser accepts a GOF: its estimate, or
// up to 2 % more.
std::uint64_t estimated_memory(const Generator& from, const ClusterGof& gof,
                               const std::vector<std::uint8_t>& payload) {
  std::uint64_t too_few = 0;
  std::uint64_t enough = kAmpleMemory;
  while (enough - too_few > std::max<std::uint64_t>(1, enough / 50)) {
    const std::uint64_t middle = too_few + (enough - too_few) / 2;
    BitReader r(payload);
    const GofHeader header = parse_gof_header(r, from.header, gof.first_frame);
    const auto parsed = parse_clusters(r, from.header, from.topology, header, {middle, 0});
    (parsed ? enough : too_few) = middle;
  }
  return enough;
}

// Measures the peak memory of parsing and reconstruction, less the memory needed for any GOF.
void expect_memory_within_estimate(const Generator& from, const ClusterGof& gof) {
  const std::vector<std::uint8_t> payload = write_cluster_gof(gof, from.header, from.topology);
  const std::uint64_t estimate = estimated_memory(from, gof, payload);
  memory_count.peak = memory_count.now;
  const std::size_t before = memory_count.now;
  {
    BitReader r(payload);
    const GofHeader header = parse_gof_header(r, from.header, gof.first_frame);
    const auto parsed =
        parse_clusters(r, from.header, from.topology, header, {kAmpleMemory, 0});
    ASSERT_TRUE(parsed);
    const ClusterRecon recon(from.header, from.topology, *parsed);
    std::vector<std::int32_t> positions(3 * std::size_t{from.header.num_vertices});
    recon.frame(0, positions);
  }
  const std::size_t any_gof_bytes =
      300'000 + 100 * std::size_t{from.header.num_vertices} + 300 * gof.clusters.size();
  EXPECT_LE(memory_count.peak - before, estimate + any_gof_bytes);
}

TEST(GofMemory, StaysWithinWhatIsComparedWithTheLimit) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Generator generator(seed);
    expect_memory_within_estimate(generator, generator.gof(400, 60, seed % 2 == 0 ? 3 : 100));
  }
}

// Each component of each cluster takes most of the memory, however few values it has.
TEST(GofMemory, OfManyComponentsOfSmallClustersIsCounted) {
  for (const int spatial_bits : {1, 16, kMaxSpatialBits}) {
    for (const int temporal_bits : {1, 16, kMaxTemporalBits}) {
      for (const std::uint32_t vertices : {1U, 43U}) {  // 3 and 129 values
        SCOPED_TRACE(testing::Message() << spatial_bits << " " << temporal_bits << " bits, "
                                        << vertices << " vertices");
        constexpr std::uint32_t kClusters = 60;
        Generator generator(1);
        generator.header.num_vertices = kClusters * vertices;
        generator.header.num_frames = 2;
        generator.topology = make_topology(kClusters * vertices, {});
        ClusterGof gof;
        gof.num_frames = 2;
        gof.clusters.resize(kClusters);
        for (std::uint32_t v = 0; v < kClusters * vertices; ++v) {
          gof.cluster_of_vertex.push_back(static_cast<std::uint16_t>(v / vertices));
        }
        Component component;
        component.spatial_bits = spatial_bits;
        component.temporal_bits = temporal_bits;
        component.temporal_residual.resize(2);
        component.spatial_residual.resize(3 * std::size_t{vertices});
        for (Cluster& cluster : gof.clusters) cluster.components.assign(100, component);
        expect_memory_within_estimate(generator, gof);
      }
    }
  }
}

}  // namespace
}  // namespace rlpc
