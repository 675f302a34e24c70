#include "encoder/codec/kinds/cluster/quantise_components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <vector>

namespace rlpc {
namespace {

using Values = std::vector<std::int32_t>;

// No triangles: a vertex can be predicted only from the one before it.
SpatialPrediction no_topology(std::uint32_t num_vertices) {
  std::vector<std::uint32_t> vertices(num_vertices);
  std::iota(vertices.begin(), vertices.end(), 0U);
  return {make_topology(num_vertices, {}), vertices,
          std::vector<std::uint16_t>(num_vertices, 0), vertices};
}

TEST(MakeSteps, ProductIsExactlyAnEntryOfTheTable) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const double s = std::exp2(static_cast<double>(random() % 60000) / 1000.0 - 30.0);
    const double t = std::exp2(static_cast<double>(random() % 60000) / 1000.0 - 40.0);
    const StepPair steps = make_steps(s, t);
    EXPECT_EQ(steps.temporal, t);
    const int octave = static_cast<int>(std::floor(steps.product_eighths / 8.0));
    const auto index = static_cast<std::size_t>(steps.product_eighths - 8 * octave);
    ASSERT_LT(index, 8U);
    const double coded = std::ldexp(kScaleMantissa[index] / 32768.0, octave);
    EXPECT_NEAR(16.0 * steps.spatial * steps.temporal / coded, 1.0, 1e-14);
    // The entries of the table are themselves rounded, to 2^-16.
    const double change = std::exp2(1.0 / 16.0) * (1.0 + 0x1p-16);
    EXPECT_LE(steps.spatial / s, change);
    EXPECT_GE(steps.spatial / s, 1.0 / change);
  }
}

TEST(MakeSteps, KeepsLegalPairs) {
  for (int eighths = -100; eighths <= 100; ++eighths) {
    const int octave = static_cast<int>(std::floor(eighths / 8.0));
    const double product = std::ldexp(
        kScaleMantissa[static_cast<std::size_t>(eighths - 8 * octave)] / 32768.0, octave);
    const StepPair steps = make_steps(product / 16.0 / 0.25, 0.25);
    EXPECT_EQ(steps.product_eighths, eighths);
    EXPECT_NEAR(steps.spatial * 4.0 / product, 1.0, 1e-14);
  }
}

TEST(Quantise, RoundsToTheNearestStep) {
  EXPECT_EQ(quantise({0.0, 0.9, 1.1, -0.9, -1.1, 7.0, -7.0}, 2.0, 0.0),
            (Values{0, 0, 1, 0, -1, 4, -4}));
  constexpr unsigned kSeed = 1;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int i = 0; i < 2000; ++i) {
    const double step = 0.01 + static_cast<double>(random() % 1000) / 100.0;
    const double x = static_cast<double>(random() % 2000001) - 1e6;
    const std::int32_t q = quantise({x}, step, 0.0)[0];
    ASSERT_LE(std::abs(q * step - x), 0.5 * step * (1.0 + 1e-9));
  }
}

TEST(Quantise, DeadZoneWidensTheZeroBinAndShiftsTheOthers) {
  EXPECT_EQ(quantise({1.05, 1.15, -1.05, -1.15, 3.05, 3.15}, 2.0, 0.06),
            (Values{0, 1, 0, -1, 1, 2}));
  EXPECT_EQ(quantise({1.9, -1.9, 2.1, -2.1, 3.9}, 2.0, 0.5), (Values{0, 0, 1, -1, 1}));
}

TEST(EstimateBits, IsZeroWithoutResidualsAndSmallForZeros) {
  EXPECT_EQ(estimate_bits({}), 0.0);
  const double zeros = estimate_bits(Values(1000, 0));
  EXPECT_GT(zeros, 0.0);
  EXPECT_LT(zeros, 100.0);
}

TEST(EstimateBits, IsNearTheEntropyOfTwoSidedGeometricResiduals) {
  for (const double r : {0.05, 0.3, 0.7, 0.95, 0.995}) {
    constexpr unsigned kSeed = 2;
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", r " << r);
    std::mt19937 random(kSeed);
    const auto uniform = [&] { return (static_cast<double>(random()) + 0.5) * 0x1p-32; };
    Values residuals(50000);
    for (std::int32_t& x : residuals) {
      x = static_cast<std::int32_t>(std::floor(std::log(uniform()) / std::log(r))) -
          static_cast<std::int32_t>(std::floor(std::log(uniform()) / std::log(r)));
    }
    std::map<std::int32_t, int> counts;
    for (const std::int32_t x : residuals) ++counts[x];
    double entropy = 0.0;
    for (const auto& [x, count] : counts) entropy -= count * std::log2(count / 50000.0);
    EXPECT_NEAR(estimate_bits(residuals) / entropy, 1.0, 0.02);
  }
}

TEST(EstimateBits, GrowsWithMagnitudesAndIgnoresSigns) {
  EXPECT_EQ(estimate_bits({3, -1, 0, 2}), estimate_bits({-2, 0, 1, 3}));
  double before = 0.0;
  for (int scale = 0; scale < 24; ++scale) {
    const std::int32_t x = 1 << scale;
    const double bits = estimate_bits({x, -x, x, 0});
    EXPECT_GT(bits, before);
    before = bits;
  }
}

TEST(ChoosePredictors, FindTheOrderOfASmoothSeries) {
  for (int degree = 0; degree <= 3; ++degree) {
    QuantisedComponent c;
    for (int f = 0; f < 60; ++f) {
      const int x = f - 30;
      c.temporal.push_back(degree == 0   ? 500
                           : degree == 1 ? 40 * x
                           : degree == 2 ? 9 * x * x
                                         : 3 * x * x * x);
    }
    c.spatial = {0, 0, 0};
    choose_predictors(c, no_topology(1));
    EXPECT_EQ(c.temporal_predictor, degree + 1);
  }
}

TEST(ChoosePredictors, LeaveNoiseUnpredicted) {
  constexpr unsigned kSeed = 3;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  QuantisedComponent c;
  for (int f = 0; f < 200; ++f) {
    c.temporal.push_back(static_cast<std::int32_t>(random() % 2001) - 1000);
  }
  for (int i = 0; i < 300; ++i) {
    c.spatial.push_back(static_cast<std::int32_t>(random() % 2001) - 1000);
  }
  choose_predictors(c, no_topology(100));
  EXPECT_EQ(c.temporal_predictor, 0);
  EXPECT_EQ(c.spatial_predictor, SpatialPredictor::kNone);
}

// On a planar square lattice, parallelogram prediction is exact. If the lattice is randomly
// bent, the mean of the neighbours has less variance.
TEST(ChoosePredictors, FollowTheShapeOfTheMesh) {
  constexpr std::uint32_t kSide = 12;
  std::vector<Triangle> triangles;
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t v = y * kSide + x;
      triangles.push_back({v, v + 1, v + kSide});
      triangles.push_back({v + 1, v + kSide + 1, v + kSide});
    }
  }
  constexpr std::uint32_t kCount = kSide * kSide;
  std::vector<std::uint32_t> all(kCount);
  std::iota(all.begin(), all.end(), 0U);
  const Topology topology = make_topology(kCount, triangles);
  const SpatialPrediction prediction(topology, all, std::vector<std::uint16_t>(kCount, 0), all);
  constexpr unsigned kSeed = 4;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (const bool smooth : {true, false}) {
    QuantisedComponent c;
    c.temporal = {1};
    for (std::uint32_t i = 0; i < 3 * kCount; ++i) {
      const auto x = static_cast<std::int32_t>(i % kCount % kSide);
      const auto y = static_cast<std::int32_t>(i % kCount / kSide);
      const auto noise = static_cast<std::int32_t>(random() % 401) - 200;
      c.spatial.push_back(smooth ? 30 * x - 70 * y + 1000 : 3000 + noise);
    }
    choose_predictors(c, prediction);
    EXPECT_EQ(c.spatial_predictor,
              smooth ? SpatialPredictor::kParallelogram : SpatialPredictor::kNeighbours);
    EXPECT_GT(c.bits, 0.0);
  }
}

QuantisedComponent random_component(std::mt19937& random, std::size_t num_frames,
                                    std::size_t num_vertices) {
  QuantisedComponent c;
  const auto value = [&](int bits) {
    return static_cast<std::int32_t>(random() % (1U << bits)) - (1 << (bits - 1));
  };
  const int temporal_bits = 2 + static_cast<int>(random() % 12);
  const int spatial_bits = 1 + static_cast<int>(random() % 16);
  for (std::size_t f = 0; f < num_frames; ++f) c.temporal.push_back(value(temporal_bits));
  for (std::size_t i = 0; i < 3 * num_vertices; ++i) c.spatial.push_back(value(spatial_bits));
  // The product of steps is small enough for positions of 20 bits.
  const double range = std::exp2(static_cast<double>(random() % 12));
  c.steps =
      make_steps(range / std::exp2(spatial_bits) * std::exp2(6),
                 std::exp2(-temporal_bits) * (1.0 + static_cast<double>(random() % 100) / 100));
  c.temporal_predictor = static_cast<int>(random() % 5);
  c.spatial_predictor = static_cast<SpatialPredictor>(random() % 3);
  return c;
}

TEST(MakeComponent, WidthsAreTheSmallestThatHoldTheValues) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const QuantisedComponent q = random_component(random, 5, 4);
    const Component c = make_component(q, no_topology(4), choose_fraction_bits({{q}}));
    const auto fits = [](std::int32_t x, int bits) { return clip_signed(bits, x) == x; };
    bool smaller_fits = true;
    for (const std::int32_t x : q.spatial) {
      EXPECT_TRUE(fits(x, c.spatial_bits));
      smaller_fits = smaller_fits && c.spatial_bits > 1 && fits(x, c.spatial_bits - 1);
    }
    EXPECT_FALSE(smaller_fits && c.spatial_bits > 1);
    smaller_fits = true;
    for (const std::int32_t x : q.temporal) {
      const std::int32_t factor = scale_temporal(x, c.scale_idx, kMaxTemporalBits);
      EXPECT_TRUE(fits(factor, c.temporal_bits));
      smaller_fits = smaller_fits && c.temporal_bits > 1 && fits(factor, c.temporal_bits - 1);
    }
    EXPECT_FALSE(smaller_fits && c.temporal_bits > 1);
  }
}

TEST(MakeComponent, ResidualsReproduceTheValues) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const QuantisedComponent q = random_component(random, 7, 9);
    const SpatialPrediction prediction = no_topology(9);
    const Component c = make_component(q, prediction, 0);
    EXPECT_EQ(recon_temporal(c), q.temporal);
    EXPECT_EQ(recon_spatial(c, prediction), q.spatial);
  }
}

// A temporal step spans at least 4 units of the factor, so rounding the factor adds at most 1/8
// of a temporal step. Rounding to the local unit of 1/16 and to the grid comes on top.
TEST(MakeComponent, FactorsReproduceTheProductOfTheValues) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    constexpr std::uint32_t kFrames = 4;
    constexpr std::uint32_t kVertices = 5;
    const QuantisedComponent q = random_component(random, kFrames, kVertices);
    ClusterGof gof;
    gof.num_frames = kFrames;
    gof.fraction_bits = choose_fraction_bits({{q}});
    ASSERT_LE(gof.fraction_bits, kMaxFractionBits);
    gof.clusters.resize(1);
    gof.cluster_of_vertex.assign(kVertices, 0);
    gof.clusters[0].components = {make_component(q, no_topology(kVertices), gof.fraction_bits)};
    SequenceHeader header;
    header.num_vertices = kVertices;
    header.position_bits = 24;
    const Topology topology = make_topology(kVertices, {});
    const ClusterRecon recon(header, topology, gof);
    std::vector<std::int32_t> positions(3 * kVertices);
    for (std::uint32_t f = 0; f < kFrames; ++f) {
      recon.frame(f, positions);
      for (std::size_t i = 0; i < kVertices; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          const double spatial = q.spatial[c * kVertices + i] * q.steps.spatial;
          const double wanted = spatial * q.temporal[f] * q.steps.temporal;
          const double tolerance =
              0.5 + 1.0 / 32.0 + 0.125 * q.steps.temporal * std::abs(spatial) + 1e-6;
          ASSERT_NEAR(positions[3 * i + c], wanted, tolerance);
        }
      }
    }
  }
}

TEST(ChooseFractionBits, IsZeroWithoutComponentsAndForCoarseFactors) {
  EXPECT_EQ(choose_fraction_bits({}), 0);
  EXPECT_EQ(choose_fraction_bits({{}, {}}), 0);
  QuantisedComponent coarse;
  coarse.spatial = Values{1 << 14, 0, 0};  // 16 bits: norm_shift() is 0
  coarse.temporal = {1};
  coarse.steps = make_steps(1.0, 0.25);  // the product of the steps is 4 local units
  EXPECT_EQ(choose_fraction_bits({{coarse}}), 0);
  coarse.steps = make_steps(1.0, 0.125);
  EXPECT_EQ(choose_fraction_bits({{coarse}}), 1);
  coarse.steps = make_steps(1.0, 0x1p-60);
  EXPECT_EQ(choose_fraction_bits({{coarse}}), kMaxFractionBits);
}

}  // namespace
}  // namespace rlpc
