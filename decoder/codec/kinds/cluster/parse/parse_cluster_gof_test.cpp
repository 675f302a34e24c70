#include "decoder/codec/kinds/cluster/parse/parse_cluster_gof.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/kinds/cluster/cluster_models.h"
#include "common/testing/element_names.h"
#include "common/testing/section_recipe.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "decoder/testing/expected_errors.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Values = std::vector<std::int32_t>;

constexpr std::uint64_t kAmple = std::uint64_t{1} << 30;

// The elements are listed in the first test.
const Bytes kLegal{0x69, 0x0C, 0x8A, 0x20, 0x74, 0x00, 0x3F, 0x00, 0x6E, 0x00, 0x07,
                   0x85, 0x48, 0xBB, 0xFD, 0x0E, 0xCB, 0x7F, 0x8D, 0xDE, 0xF3, 0x06,
                   0x19, 0x1A, 0x9D, 0x6D, 0xDA, 0xBE, 0x9A, 0x43, 0x0E, 0x99, 0xF6,
                   0xE3, 0x4C, 0x94, 0x18, 0x39, 0x34, 0xBA, 0x6C, 0xD8, 0xE1};

SequenceHeader header_of(std::uint32_t num_vertices, std::uint32_t num_frames) {
  SequenceHeader header;
  header.num_vertices = num_vertices;
  header.num_frames = num_frames;
  header.position_bits = 12;
  return header;
}

Result<ClusterGof> parse_legal(const Bytes& payload, Trace* trace = nullptr,
                               std::uint64_t max_memory_bytes = kAmple) {
  const Topology topology =
      make_topology(5, std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {3, 1, 4}});
  BitReader r(payload, 0, trace);
  const SequenceHeader header = header_of(5, 5);
  return parse_clusters(r, header, topology, parse_gof_header(r, header, 2),
                        {max_memory_bytes, 0});
}

TEST(ParseGof, GivesTheElements) {
  ElementNames names;
  const auto gof = parse_legal(kLegal, &names);
  ASSERT_TRUE(gof);
  EXPECT_TRUE(names.in_order);
  EXPECT_EQ(names.text,
            "first_frame 2\nnum_gof_frames_minus1 1\nnum_clusters_minus1 1\nfraction_bits 3\n"
            "seed_step_minus1 3\nseed_predictor 2\nseed_coupling_flag 1\n"
            "lcf_flag 1\nseed_vertex 2 0 1\nlcf_flag 0\n"
            "cluster_predicted_flag 1 0\ncluster_idx 1\n"
            "seed_residual 10 -20 30 1 0 -1 5 0 0 0 0 2 0 6 0 0 -3 0\n"
            "num_components_delta 1 1\n"
            "scale_idx_delta 30\nspatial_bits_delta 5\ntemporal_bits_delta 6\n"
            "temporal_predictor 1\nspatial_predictor 1\n"
            "temporal_residual 50 -2\nspatial_residual 20 -31 4\n"
            "scale_idx_delta -2\nspatial_bits_delta -1\ntemporal_bits_delta 0\n"
            "temporal_predictor 0\nspatial_predictor 0\n"
            "temporal_residual -3 0\nspatial_residual 1 0 -15\n"
            "scale_idx_delta 0\nspatial_bits_delta 0\ntemporal_bits_delta 2\n"
            "temporal_predictor 4\nspatial_predictor 2\n"
            "temporal_residual 200 17\nspatial_residual 2 -1 3");

  EXPECT_EQ(gof->first_frame, 2U);
  EXPECT_EQ(gof->num_frames, 2U);
  EXPECT_EQ(gof->fraction_bits, 3);
  EXPECT_EQ(gof->seed_step, 4U);
  EXPECT_EQ(gof->seed_predictor, 2);
  EXPECT_TRUE(gof->seed_coupling_flag);
  EXPECT_EQ(gof->cluster_of_vertex,
            (std::vector<std::uint16_t>{kSeedCluster, kSeedCluster, kSeedCluster, 0, 1}));
  ASSERT_EQ(gof->seed_tracks.size(), 3U);
  EXPECT_EQ(gof->seed_tracks[1].vertex, 0U);
  EXPECT_EQ(gof->seed_tracks[1].residual, (std::vector<Vec3i>{{5, 0, 0}, {0, 0, 2}}));
  ASSERT_EQ(gof->clusters.size(), 2U);
  EXPECT_TRUE(gof->clusters[0].lcf_flag);
  EXPECT_EQ(gof->clusters[0].seed_vertex, (std::array<std::uint32_t, 3>{2, 0, 1}));
  EXPECT_FALSE(gof->clusters[1].lcf_flag);
  ASSERT_EQ(gof->clusters[1].components.size(), 2U);
  const Component& last = gof->clusters[1].components[1];
  EXPECT_EQ(last.scale_idx, 28);
  EXPECT_EQ(last.spatial_bits, 5);
  EXPECT_EQ(last.temporal_bits, 9);
  EXPECT_EQ(last.temporal_predictor, 4);
  EXPECT_EQ(last.spatial_predictor, SpatialPredictor::kParallelogram);
  EXPECT_EQ(last.temporal_residual, (Values{200, 17}));
  EXPECT_EQ(last.spatial_residual, (Values{2, -1, 3}));
}

// A payload cut off in large residuals can be a GOF of smaller ones; these end in small ones.
TEST(ParseGof, EveryProperPrefixFails) {
  for (std::size_t n = 0; n < kLegal.size(); ++n) {
    const Bytes exact(kLegal.begin(), kLegal.begin() + static_cast<std::ptrdiff_t>(n));
    const auto gof = parse_legal(exact);
    ASSERT_FALSE(gof) << n;
    EXPECT_EQ(gof.error().code, n < 3 ? Errc::kTruncated : Errc::kInvalid) << n;
  }
}

TEST(ParseGof, SurplusBytesFail) {
  Bytes longer = kLegal;
  longer.push_back(0);
  expect_invalid(parse_legal(longer), "R-RNG-01", "gof_section");
}

TEST(ParseGof, SectionMustNotStartWithOnes) {
  Bytes wrong = kLegal;
  std::fill(wrong.begin() + 3, wrong.begin() + 7, std::uint8_t{0xFF});
  expect_invalid(parse_legal(wrong), "R-RNG-02", "gof_section");
}

TEST(ParseGof, FactorsStayWithinTheMemoryOfTheCaller) {
  EXPECT_TRUE(parse_legal(kLegal, nullptr, 6000));
  const std::vector<std::pair<std::uint64_t, std::string>> too_few{
      {0, "seed_residual"}, {1000, "num_components_delta"}};
  for (const auto& [bytes, element] : too_few) {
    const auto gof = parse_legal(kLegal, nullptr, bytes);
    ASSERT_FALSE(gof);
    EXPECT_EQ(gof.error().code, Errc::kLimitExceeded);
    EXPECT_EQ(gof.error().element, element);
  }
}

// Writes a payload bin by bin. Without triangles, every cluster_predicted_flag has context 0.
class Recipe : public SectionRecipe {
 public:
  std::uint32_t first_frame = 0;
  std::uint32_t num_gof_frames_minus1 = 0;
  std::uint32_t num_clusters_minus1 = 0;
  std::uint32_t fraction_bits = 0;
  std::uint32_t seed_step_minus1 = 0;
  std::uint32_t seed_predictor = 1;
  int vertex_bits = 3;  // for 5 to 8 vertices
  ClusterModels models;

  void lcf_flag(bool value) { section.bin(models.lcf_flag, value); }
  void seeds(std::initializer_list<std::uint32_t> vertices) {
    lcf_flag(true);
    for (const std::uint32_t v : vertices) section.bypass(vertex_bits, v);
  }
  void header_delta(HeaderField field, std::int32_t delta) {
    SectionRecipe::header_delta(models.header,
                                models.header_mean[static_cast<std::size_t>(field)], delta);
  }
  Bytes payload() {
    BitWriter w;
    w.ue(first_frame);
    w.ue(num_gof_frames_minus1);
    w.ue(num_clusters_minus1);
    w.u(5, fraction_bits);
    w.ue(seed_step_minus1);
    w.u(3, seed_predictor);
    w.flag(false);
    w.byte_alignment();
    w.append(section.finish());
    return w.take();
  }
};

Result<ClusterGof> parse(const Bytes& payload, const SequenceHeader& header,
                         std::uint32_t first_frame = 0) {
  const Topology topology = make_topology(header.num_vertices, {});
  BitReader r(payload);
  return parse_clusters(r, header, topology, parse_gof_header(r, header, first_frame),
                        {kAmple, 0});
}

// Returns one world cluster without components.
Bytes plain(Recipe recipe) {
  for (std::uint32_t i = 0; i <= recipe.num_clusters_minus1; ++i) recipe.lcf_flag(false);
  if (recipe.num_clusters_minus1 > 0) {
    for (int v = 0; v < 5; ++v)
      recipe.section.bin(recipe.models.cluster_predicted_flag[0], true);
  }
  for (std::uint32_t i = 0; i <= recipe.num_clusters_minus1; ++i) {
    recipe.header_delta(HeaderField::kNumComponents, 0);
  }
  return recipe.payload();
}

TEST(ParseGof, EveryFixedElementIsTakenUpToItsBoundsAndNotBeyond) {
  struct Case {
    std::function<void(Recipe&, std::uint32_t beyond)> set;
    const char* rule;
    const char* element;
  };
  const std::vector<Case> cases{
      {[](Recipe& r, std::uint32_t b) { r.first_frame += b; }, "R-GOF-01", "first_frame"},
      {[](Recipe& r, std::uint32_t b) { r.first_frame -= b; }, "R-GOF-01", "first_frame"},
      {[](Recipe& r, std::uint32_t b) { r.num_gof_frames_minus1 = 92 + b; }, "R-GOF-02",
       "num_gof_frames_minus1"},
      {[](Recipe& r, std::uint32_t b) { r.num_clusters_minus1 = 255 + b; }, "R-LVL-06",
       "num_clusters_minus1"},
      {[](Recipe& r, std::uint32_t b) { r.fraction_bits = 24 + b; }, "R-GOF-03",
       "fraction_bits"},
      {[](Recipe& r, std::uint32_t b) { r.seed_step_minus1 = 65535 + b; }, "R-GOF-04",
       "seed_step_minus1"},
      {[](Recipe& r, std::uint32_t b) { r.seed_predictor = 4 + b; }, "R-GOF-05",
       "seed_predictor"},
  };
  for (const Case& k : cases) {
    Recipe recipe;
    recipe.first_frame = 7;
    k.set(recipe, 0);
    EXPECT_TRUE(parse(plain(recipe), header_of(5, 100), 7)) << k.rule;
    k.set(recipe, 1);
    expect_invalid(parse(plain(recipe), header_of(5, 100), 7), k.rule, k.element);
  }
}

TEST(ParseGofHeader, HasAFlagForBonesInTheMainProfileAlone) {
  for (const std::uint32_t profile_idc : {kProfileBaseline, kProfileMain}) {
    for (const bool bones_flag : {false, true}) {
      SequenceHeader header = header_of(5, 20);
      header.profile_idc = profile_idc;
      BitWriter w;
      w.ue(3);
      w.ue(16);
      w.flag(bones_flag);
      w.u(5, 21);
      w.byte_alignment();
      const Bytes payload = w.take();
      BitReader r(payload);
      const GofHeader gof = parse_gof_header(r, header, 3);
      EXPECT_EQ(gof.first_frame, 3U);
      EXPECT_EQ(gof.num_frames, 17U);
      EXPECT_EQ(gof.kind == GofKind::kSkinned, profile_idc == kProfileMain && bones_flag);
      EXPECT_EQ(r.bit_pos(), profile_idc == kProfileMain ? 15U : 14U);
      EXPECT_FALSE(r.error());
      // All but the last three bits of these elements.
      const Bytes prefix(payload.begin(), payload.begin() + 1);
      BitReader cut(prefix);
      parse_gof_header(cut, header, 3);
      EXPECT_TRUE(cut.error());
    }
  }
}

TEST(ParseGof, LevelsBoundFramesAndPositions) {
  Recipe recipe;
  recipe.num_gof_frames_minus1 = 511;
  EXPECT_TRUE(parse(plain(recipe), header_of(5, 1000)));
  recipe.num_gof_frames_minus1 = 512;
  expect_invalid(parse(plain(recipe), header_of(5, 1000)), "R-LVL-04", "num_gof_frames_minus1");
  recipe.num_gof_frames_minus1 = 255;
  EXPECT_TRUE(parse(plain(recipe), header_of(16384, 1000)));  // 2^22 positions
  recipe.num_gof_frames_minus1 = 256;
  expect_invalid(parse(plain(recipe), header_of(16384, 1000)), "R-LVL-04",
                 "num_gof_frames_minus1");
}

TEST(ParseGof, SeedsAreThreeDifferentVertices) {
  const auto parse_seeds = [](std::initializer_list<std::uint32_t> vertices) {
    Recipe recipe;
    recipe.seeds(vertices);
    for (int i = 0; i < 9; ++i) recipe.residual(recipe.models.seed, 0, 0);
    recipe.header_delta(HeaderField::kNumComponents, 0);
    return parse(recipe.payload(), header_of(5, 1));
  };
  EXPECT_TRUE(parse_seeds({4, 0, 2}));
  expect_invalid(parse_seeds({5, 0, 2}), "R-GOF-06", "seed_vertex");
  expect_invalid(parse_seeds({4, 7, 2}), "R-GOF-06", "seed_vertex");
  expect_invalid(parse_seeds({4, 0, 6}), "R-GOF-06", "seed_vertex");
  expect_invalid(parse_seeds({4, 4, 2}), "R-GOF-07", "seed_vertex");
  expect_invalid(parse_seeds({4, 2, 2}), "R-GOF-07", "seed_vertex");
  expect_invalid(parse_seeds({4, 2, 4}), "R-GOF-07", "seed_vertex");
}

TEST(ParseGof, SharedSeedsHaveOneTrackWithTheAnchorOfTheFirstCluster) {
  Recipe recipe;
  recipe.num_clusters_minus1 = 1;
  recipe.seeds({0, 1, 2});
  recipe.seeds({2, 3, 1});
  recipe.section.bin(recipe.models.cluster_predicted_flag[0], true);  // vertex 4
  for (int i = 0; i < 12; ++i) recipe.residual(recipe.models.seed, 0, 0);
  recipe.header_delta(HeaderField::kNumComponents, 0);
  recipe.header_delta(HeaderField::kNumComponents, 0);
  const auto gof = parse(recipe.payload(), header_of(5, 1));
  ASSERT_TRUE(gof);
  ASSERT_EQ(gof->seed_tracks.size(), 4U);
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(gof->seed_tracks[i].vertex, i);
    EXPECT_EQ(gof->seed_tracks[i].anchor, i < 3 ? 0U : 2U);
  }
}

TEST(ParseGof, ClusterIndicesAreBelowTheNumberOfClusters) {
  for (const std::uint32_t cluster_idx : {2U, 3U}) {
    Recipe recipe;
    recipe.num_clusters_minus1 = 2;
    for (int i = 0; i < 3; ++i) recipe.lcf_flag(false);
    recipe.models.cluster_idx.resize(4);
    recipe.section.bin(recipe.models.cluster_predicted_flag[0], false);
    recipe.section.bin(recipe.models.cluster_idx[1], true);
    recipe.section.bin(recipe.models.cluster_idx[3], cluster_idx == 3);
    for (int v = 1; v < 5; ++v)
      recipe.section.bin(recipe.models.cluster_predicted_flag[0], true);
    for (int i = 0; i < 3; ++i) recipe.header_delta(HeaderField::kNumComponents, 0);
    const auto gof = parse(recipe.payload(), header_of(5, 1));
    if (cluster_idx == 2) {
      ASSERT_TRUE(gof);
      EXPECT_EQ(gof->cluster_of_vertex, std::vector<std::uint16_t>(5, 2));
    } else {
      expect_invalid(gof, "R-GOF-08", "cluster_idx");
    }
  }
}

TEST(ParseGof, ComponentsOfAClusterAreBoundedByTheLevel) {
  for (const std::int32_t count : {-1, 513}) {
    Recipe recipe;
    recipe.lcf_flag(false);
    recipe.header_delta(HeaderField::kNumComponents, count);
    expect_invalid(parse(recipe.payload(), header_of(5, 1)), "R-GOF-09",
                   "num_components_delta");
  }
}

// Factors of 16384 vertices and 256 frames; 170 components have more than 2^23. With fewer
// components, missing bytes are detected after the first.
TEST(ParseGof, FactorsAreBoundedByTheLevel) {
  for (const std::int32_t count : {169, 170}) {
    Recipe recipe;
    recipe.num_gof_frames_minus1 = 255;
    recipe.lcf_flag(false);
    recipe.header_delta(HeaderField::kNumComponents, count);
    const auto gof = parse(recipe.payload(), header_of(16384, 256));
    if (count == 170) {
      expect_invalid(gof, "R-LVL-05", "num_components_delta");
    } else {
      ASSERT_FALSE(gof);
      EXPECT_NE(gof.error().rule, std::string("R-LVL-05"));
    }
  }
}

// Parses two components; the arguments are the deltas of the second.
Result<ClusterGof> parse_deltas(std::int32_t scale_idx, std::int32_t spatial_bits,
                                std::int32_t temporal_bits) {
  Recipe recipe;
  recipe.vertex_bits = 2;
  recipe.seeds({0, 1, 2});
  for (int i = 0; i < 9; ++i) recipe.residual(recipe.models.seed, 0, 0);
  recipe.header_delta(HeaderField::kNumComponents, 2);
  std::vector<std::uint32_t> frame_mean(1, 0);
  Component c;
  for (const bool second : {false, true}) {
    const std::int32_t s = second ? scale_idx : 100;
    const std::int32_t n = second ? spatial_bits : 5;   // from 1
    const std::int32_t t = second ? temporal_bits : 8;  // from 1
    recipe.header_delta(HeaderField::kScaleIdx, s);
    recipe.header_delta(HeaderField::kSpatialBits, n);
    recipe.header_delta(HeaderField::kTemporalBits, t);
    c.scale_idx += s;
    c.spatial_bits += n;
    c.temporal_bits += t;
    recipe.section.bin(recipe.models.temporal_predictor[0], false);
    recipe.section.bin(recipe.models.spatial_predictor[0], false);
    if (c.spatial_bits < 1 || c.temporal_bits < 1) break;
    TemporalContext temporal(frame_mean, c);
    recipe.residual(recipe.models.temporal, temporal.expected(0), 0);
    temporal.update(0, 0);
  }
  return parse(recipe.payload(), header_of(3, 1));
}

TEST(ParseGof, ComponentHeadersAreWithinTheirRanges) {
  EXPECT_TRUE(parse_deltas(0, 0, 0));
  EXPECT_TRUE(parse_deltas(27, 18, 17));
  EXPECT_TRUE(parse_deltas(-100, -5, -8));
  expect_invalid(parse_deltas(28, 0, 0), "R-GOF-10", "scale_idx_delta");
  expect_invalid(parse_deltas(-101, 0, 0), "R-GOF-10", "scale_idx_delta");
  expect_invalid(parse_deltas(0, 19, 0), "R-GOF-11", "spatial_bits_delta");
  expect_invalid(parse_deltas(0, -6, 0), "R-GOF-11", "spatial_bits_delta");
  expect_invalid(parse_deltas(0, 0, 18), "R-GOF-12", "temporal_bits_delta");
  expect_invalid(parse_deltas(0, 0, -9), "R-GOF-12", "temporal_bits_delta");
}

}  // namespace
}  // namespace rlpc
