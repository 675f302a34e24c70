#include "encoder/codec/kinds/cluster/variant_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

constexpr double kStep = 16.0;  // has no effect, as the quantisers are given

// Squares of different sizes in a sheet that waves, with a jolt, in grid steps.
struct Sheet {
  static constexpr std::uint32_t kSide = 9;
  static constexpr std::uint32_t kFrames = 16;
  SequenceHeader header;
  std::vector<Triangle> triangles;
  std::vector<Triangle> input_triangles;
  Topology topology;
  SpanFrames frames;

  Sheet() {
    for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
      for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
        const std::uint32_t v = y * kSide + x;
        triangles.push_back({v, v + 1, v + kSide});
        triangles.push_back({v + 1, v + kSide + 1, v + kSide});
      }
    }
    input_triangles.assign(triangles.rbegin(), triangles.rend());
    header.num_vertices = frames.num_vertices = kSide * kSide;
    header.num_triangles = static_cast<std::uint32_t>(triangles.size());
    header.num_frames = frames.num_frames = kFrames;
    header.position_bits = 20;
    topology = make_topology(header.num_vertices, triangles);
    for (std::uint32_t f = 0; f < kFrames; ++f) {
      for (std::uint32_t v = 0; v < header.num_vertices; ++v) {
        const double x = v % kSide;
        const std::uint32_t row = v / kSide;
        const double y = row;
        const double jolt = f > 9 && x > 4 ? 2000.0 : 0.0;
        frames.xyz.insert(frames.xyz.end(), {100.0 * x * x + 20.0 * y, 700.0 * y,
                                             900.0 * std::sin(0.5 * f + 0.4 * x) * y + jolt});
      }
    }
  }
  SequenceMesh mesh() const { return {header, topology, triangles, input_triangles}; }
};

EncoderSettings paper_settings() {
  EncoderSettings s;
  s.profile = Profile::kBaseline;
  s.target = {Target::kNone, 0.0};
  s.components = 3;
  s.baseline.clusters = 4;
  s.baseline.rdo = false;
  s.baseline.qu = s.baseline.qc = s.baseline.qdelta = 12;
  s.baseline.frame_mode = FrameMode::kLcf;
  return s;
}

struct Cost {
  double error = 0.0;
  double bits = 0.0;
};

Cost cost_of(const ClusterGofCoding& coding, const Clustering& clustering) {
  const EncodedSpan encoded = coding.encode(kStep, coding.analyse(kStep, false, clustering));
  return {squared_error(coding.frames(), encoded.frame), bits_of(encoded)};
}

bool equal(const Clustering& a, const Clustering& b) {
  return a.seeds == b.seeds && a.cluster_of_vertex == b.cluster_of_vertex;
}

TEST(SearchVariants, FindsOneThatNoOtherBeatsInErrorAndBitsNorTheLiteralOneInError) {
  const Sheet sheet;
  const SequenceMesh mesh = sheet.mesh();
  for (const std::uint32_t components : {1U, 3U}) {
    EncoderSettings settings = paper_settings();
    settings.components = components;
    ASSERT_TRUE(has_variants(settings));
    const ClusterGofCoding coding(mesh, settings, sheet.frames);
    const std::array<ClusterChoice, 1> choices{{{settings.baseline.clusters, false}}};
    const FoundVariant found = search_variants(coding, kStep, choices);
    const Cost min = cost_of(coding, found.clustering);
    int same = 0;
    std::vector<Clustering> different;
    for (const SeedMode seeds : {SeedMode::kTriangle, SeedMode::kFirst, SeedMode::kSpread}) {
      for (const MotionMeasure motion : {MotionMeasure::kSquared, MotionMeasure::kPlain}) {
        EncoderSettings one = settings;
        one.baseline.seed_mode = seeds;
        one.baseline.motion = motion;
        EXPECT_FALSE(has_variants(one));
        const ClusterGofCoding variant(mesh, one, sheet.frames);
        const Clustering clustering =
            variant.cluster(*variant.cluster_maker(), one.baseline.clusters);
        if (equal(clustering, found.clustering)) ++same;
        if (std::none_of(different.begin(), different.end(),
                         [&](const Clustering& c) { return equal(c, clustering); })) {
          different.push_back(clustering);
        }
        const Cost cost = cost_of(variant, clustering);
        EXPECT_FALSE(cost.error < min.error && cost.bits < min.bits);
        const bool is_literal = seeds == SeedMode::kFirst && motion == MotionMeasure::kPlain;
        if (is_literal) {
          EXPECT_LE(min.error, cost.error);
        }
      }
    }
    EXPECT_GT(same, 0);
    EXPECT_GT(different.size(), 2U) << "the variants are too much alike for this test";
  }
}

TEST(SearchVariants, WorldCoordinatesAreNoExcuseForMoreError) {
  const Sheet sheet;
  const SequenceMesh mesh = sheet.mesh();
  const EncoderSettings settings = paper_settings();
  EncoderSettings literal = settings;
  literal.baseline.seed_mode = SeedMode::kFirst;
  literal.baseline.motion = MotionMeasure::kPlain;
  const ClusterGofCoding coding(mesh, literal, sheet.frames);
  const auto error_of = [&](const ClusterChoice& choice, const Clustering& clustering) {
    const EncodedSpan encoded =
        coding.encode(kStep, coding.analyse(kStep, choice.world, clustering));
    return squared_error(sheet.frames, encoded.frame);
  };
  const std::uint32_t count = settings.baseline.clusters;
  const Clustering as_it_reads = coding.cluster(*coding.cluster_maker(), count);
  for (const bool world_first : {false, true}) {
    const std::array<ClusterChoice, 2> choices{{{count, world_first}, {count, !world_first}}};
    const FoundVariant found =
        search_variants(ClusterGofCoding(mesh, settings, sheet.frames), kStep, choices);
    EXPECT_LE(error_of(found.choice, found.clustering), error_of(choices[0], as_it_reads));
  }
}

TEST(SearchVariants, IsForTheQuantisersOfThePaper) {
  EncoderSettings settings = paper_settings();
  settings.baseline.seed_mode = SeedMode::kTriangle;
  EXPECT_TRUE(has_variants(settings));  // two measures of motion
  settings.baseline.motion = MotionMeasure::kPlain;
  EXPECT_FALSE(has_variants(settings));
  settings = paper_settings();
  settings.baseline.partition = PartitionMethod::kLloyd;
  EXPECT_TRUE(has_variants(settings));  // triangles or distant vertices
  settings.baseline.seed_mode = SeedMode::kSpread;
  EXPECT_FALSE(has_variants(settings));
  settings = paper_settings();
  settings.baseline.qu = settings.baseline.qc = 0;
  EXPECT_FALSE(has_variants(settings));
}

TEST(ClusterGofCoding, SeedBitsAreRelativeToTheBoxesOfTheFrames) {
  Sheet sheet;
  // From frame 8 on, the sheet is twice as large.
  for (std::size_t i = sheet.frames.xyz.size() / 2; i < sheet.frames.xyz.size(); ++i) {
    sheet.frames.xyz[i] = 2.0 * sheet.frames.xyz[i - sheet.frames.xyz.size() / 2];
  }
  double sum = 0.0;
  for (std::uint32_t f = 0; f < Sheet::kFrames; ++f) {
    double largest = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<double> values;
      for (std::uint32_t v = 0; v < sheet.frames.num_vertices; ++v) {
        values.push_back(sheet.frames.at(f, v)[c]);
      }
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      largest = std::max(largest, *high - *low);
    }
    sum += largest;
  }
  const SequenceMesh mesh = sheet.mesh();
  for (const int bits : {6, 8, 24}) {
    EncoderSettings settings = paper_settings();
    settings.baseline.qdelta = bits;
    const ClusterGofCoding coding(mesh, settings, sheet.frames);
    const Clustering clustering = coding.cluster(*coding.cluster_maker(), 4);
    const double step = sum / Sheet::kFrames / std::exp2(bits);
    EXPECT_EQ(coding.analyse(kStep, false, clustering).gof.seed_step,
              std::max(1.0, std::floor(step)));
  }
}

}  // namespace
}  // namespace rlpc
