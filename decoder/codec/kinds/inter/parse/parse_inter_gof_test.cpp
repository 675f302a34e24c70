#include "decoder/codec/kinds/inter/parse/parse_inter_gof.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/element_names.h"
#include "decoder/codec/parse/rig_memory.h"
#include "decoder/testing/inter_gof_units.h"

namespace rlpc {
namespace {

using Residuals = std::vector<std::int32_t>;

// A GOF written by rlpcgen, from the specification. The first unit is the GOF unit.
struct LegalGof {
  std::uint32_t num_frames;
  std::vector<Bytes> units;
  std::vector<std::size_t> section_start;  // of each unit, in bytes
  std::vector<std::string> elements;       // of each unit
};

// This one has two layer groups and temporal layers, a dyadic pattern, patches and hashes.
const LegalGof kDyadic{
    5,
    {{0x97, 0x91, 0x05, 0x41, 0x00, 0x00, 0x04, 0x00, 0x01, 0x8E, 0xEB, 0x69, 0x7C, 0x88, 0x2A,
      0x20, 0xAF, 0x97, 0x20},
     {0xE0, 0x00, 0x03, 0xD6, 0x06, 0x85, 0xD9, 0x82, 0x61, 0x17, 0x80, 0xF8, 0x54, 0xC4, 0x60,
      0xBE, 0x14, 0xD8, 0x38},
     {0xA8, 0x12, 0x34, 0x56, 0x78, 0x9B, 0x18, 0x64, 0x57, 0x04, 0xCD, 0x0C, 0x97},
     {0x2E, 0x90, 0x30, 0xB2, 0xEC, 0x87, 0xCE, 0x93, 0x7B, 0x66, 0xF4,
      0x75, 0x31, 0x91, 0x13, 0xE1, 0xED, 0x70, 0x3A, 0x9C, 0x1E},
     {0x2A, 0x80, 0x00, 0x00, 0x00, 0x01, 0x71, 0x92, 0xBD, 0x2A},
     {0x7D, 0x00, 0x27, 0xFF, 0x73, 0x6D, 0x37},
     {0x6A, 0xFF, 0xFF, 0xFF, 0xFF, 0x48},
     {0x5F},
     {0x26, 0xA4, 0xE5, 0xA7, 0x98, 0x10, 0x55, 0x73}},
    {16, 1, 5, 1, 6, 2, 5, 1, 1},
    {"first_frame 0\nnum_gof_frames_minus1 4\ngof_kind 3\nframe_pattern_idc 2\n"
     "pattern_period_log2 2\ntemporal_layers_minus1 1\nexact_flag 0\n"
     "frame_step_minus1 20 31 65535\ndamping_log2 6\nouter_weight 3\nouter_scale 11\n"
     "learning_flag 1\nprime_log2 5\nframe_hash_flag 1\nmax_earlier_distance 2\n"
     "num_layer_groups_minus1 1\nlayer_group_layers_minus1 1\nlayer_step_minus1 15 9 1\n"
     "rest_order_flag 0\nrest_step_minus1 20\nframe_step_delta_flag 0\nnum_patches "
     "3\ncluster_predicted_flag "
     "0\ncluster_idx "
     "2\ncluster_predicted_flag 1 0\n"
     "cluster_idx 0\ncluster_predicted_flag 1 1 1 0\ncluster_idx 1\n"
     "cluster_predicted_flag 1 1",
     // NOLINTNEXTLINE(bugprone-suspicious-missing-comma): lines of one unit
     "frame_idx 0\nlayer_group_idx 0\nunit_frames_minus1 0\n"
     "frame_residual 40 -20 7 3 1 -1 2000 -5 6 9 -8 0 1 4 -3",
     "frame_idx 0\nlayer_group_idx 1\nunit_frames_minus1 0\nframe_crc 305419896\n"
     "frame_residual 1 0 -2 3 0 1 5 -1 0 2 2 -1",
     "frame_idx 4\nlayer_group_idx 0\nunit_frames_minus1 0\nearlier_flag 0\npatch_mode 0 1\n"
     "patch_residual 12 -7 3 1 0 0 -2 1 0 0 5 -1\npatch_mode 2\n"
     "patch_residual 4 0 0 300 -1 0 0 2 0 0 -9 1\n"
     "frame_residual 3 0 -1 1 2 0 0 0 0 0 0 0",
     "frame_idx 4\nlayer_group_idx 1\nunit_frames_minus1 0\nframe_crc 1\nframe_residual -1 0 2 "
     "2 2 2 2 2 2",
     "frame_idx 2\nlayer_group_idx 0\nunit_frames_minus1 0\nearlier_flag "
     "1\nearlier_distance_minus1 1\n"
     "repeat_flag 0\npatch_mode 2\npatch_residual 1 0 0 0 0 0 0 0 0 0 0 0\npatch_mode 2\n"
     "patch_residual 0 0 0 0 0 0 0 0 0 0 0 0\npatch_mode 1\n"
     "patch_residual 0 0 0 0 0 0 0 0 0 0 0 0\nframe_residual 0 1 1",
     "frame_idx 2\nlayer_group_idx 1\nunit_frames_minus1 0\nframe_crc "
     "4294967295\nframe_residual 1 1 1",
     "frame_idx 1\nlayer_group_idx 0\nunit_frames_minus1 0\nearlier_flag "
     "1\nearlier_distance_minus1 0\n"
     "repeat_flag 1",
     "frame_idx 3\nlayer_group_idx 0\nunit_frames_minus1 0\nearlier_flag 0\npatch_mode 0 0 2\n"
     "patch_residual 1 1 1 1 1 1 1 1 1 1 1 1\n"
     "frame_residual 0 0 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1"}};

// This one has an explicit pattern, exact positions, a first frame in an order of its own, and
// several frames in each unit.
const LegalGof kExplicit{
    7,
    {{0x9F, 0xC4, 0x20, 0x00, 0x10, 0x03, 0x21, 0x02, 0xD4, 0x7C, 0x02, 0x7F, 0x83, 0xC0},
     {0xD0, 0x00, 0x03, 0xD6, 0x00, 0x36, 0xCC, 0xA6, 0x5B, 0x1C, 0xF3, 0x0D, 0x93,
      0x9B, 0x2A, 0x03, 0xEC, 0xA1, 0x31, 0x41, 0x2F, 0xE0, 0xB5, 0x87, 0x14, 0x73},
     {0x56, 0xBE, 0x05, 0x67, 0x07, 0x3E, 0xFF, 0xC3},
     {0x74, 0xE0, 0x47, 0xE9, 0x85, 0xA0, 0x20}},
    {14, 1, 2, 2},
    {"first_frame 0\nnum_gof_frames_minus1 6\ngof_kind 3\nframe_pattern_idc 3\n"
     "pattern_period_minus1 2\npattern_offset_minus1 2\ntwo_references_flag 0\n"
     "pattern_reference 0\npattern_depth 0\npattern_offset_minus1 0\ntwo_references_flag 1\n"
     "pattern_reference 0 3\npattern_depth 1\npattern_offset_minus1 1\n"
     "two_references_flag 0\npattern_reference 1\npattern_depth 3\n"
     "temporal_layers_minus1 2\nexact_flag 1\ndamping_log2 1\nouter_weight 15\n"
     "outer_scale 0\nlearning_flag 0\nframe_hash_flag 0\nmax_earlier_distance 3\n"
     "num_layer_groups_minus1 0\nrest_order_flag 1\nrest_edge_weight 63\n"
     "rest_ring_weight 1\nrest_axes_flag 1\nrest_counterparts_flag 1\nnum_patches 0",
     "frame_idx 0\nlayer_group_idx 0\nunit_frames_minus1 1\nearlier_flag 0\n"
     "vertex_residual 40 -20 7 3 1 -1 20 -5 6 9 -8 0\nnew_counterpart_flag 0\n"
     "vertex_residual 1 4 -3\nnew_counterpart_flag 1\ncounterpart_hinge 0\n"
     "counterpart_idx 0\ncounterpart_mirrored_flag 1\nvertex_residual -3 -3 -3\n"
     "new_counterpart_flag 0\nvertex_residual -3 -3 -3\ncounterpart_flag 1\n"
     "vertex_residual -3 -3 -3\nnew_counterpart_flag 0\nvertex_residual -3 -3 -3\n"
     "frame_residual 3 0 -1 1 2 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0",
     "frame_idx 1\nlayer_group_idx 0\nunit_frames_minus1 2\nearlier_flag 0 1\n"
     "earlier_distance_minus1 2\nrepeat_flag 1\nearlier_flag 1\nearlier_distance_minus1 0\n"
     "repeat_flag 0\nframe_residual 5 0 -1 1 2 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
     "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0",
     "frame_idx 2\nlayer_group_idx 0\nunit_frames_minus1 1\nearlier_flag 0 1\n"
     "earlier_distance_minus1 0\nrepeat_flag 1\nframe_residual 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 "
     "1 1 1 1 1 1 1 1 1 1 1 1"}};

const std::vector<LegalGof> kLegalGofs{kDyadic, kExplicit};

InterGofUnits units_of(const LegalGof& gof,
                       std::uint64_t max_memory_bytes = std::uint64_t{1} << 30,
                       const SliceCut& cut = {}) {
  return InterGofUnits(high_header(9, gof.num_frames), kSquares, max_memory_bytes, cut);
}

Result<bool> add_unit(InterGofUnits& units, std::size_t unit, const Bytes& payload,
                      Trace* trace = nullptr) {
  return unit == 0 ? units.gof(payload, trace) : units.frame(payload, trace);
}

// Parses a unit after those before it, whose bytes are right.
Result<bool> parse_unit(const LegalGof& gof, std::size_t unit, const Bytes& payload,
                        Trace* trace = nullptr) {
  InterGofUnits units = units_of(gof);
  for (std::size_t i = 0; i < unit; ++i) EXPECT_TRUE(add_unit(units, i, gof.units[i]));
  return add_unit(units, unit, payload, trace);
}

InterGof parsed(const LegalGof& gof) {
  InterGofUnits units = units_of(gof);
  for (std::size_t i = 0; i < gof.units.size(); ++i) {
    EXPECT_TRUE(add_unit(units, i, gof.units[i])) << i;
  }
  return units.parser().finish();
}

TEST(ParseInterGof, GivesTheElements) {
  for (const LegalGof& gof : kLegalGofs) {
    InterGofUnits units = units_of(gof);
    for (std::size_t i = 0; i < gof.units.size(); ++i) {
      ElementNames names;
      const auto ok = add_unit(units, i, gof.units[i], &names);
      ASSERT_TRUE(ok) << i << ' ' << ok.error().rule << ' ' << ok.error().element;
      EXPECT_EQ(names.text, gof.elements[i]);
      EXPECT_TRUE(names.in_order);
    }
  }
}

TEST(ParseInterGof, FillsTheSettings) {
  const InterGof gof = parsed(kDyadic);
  EXPECT_EQ(gof.kind, GofKind::kInter);
  EXPECT_EQ(gof.first_frame, 0U);
  EXPECT_EQ(gof.num_frames, 5U);
  EXPECT_EQ(gof.pattern.kind, FramePattern::kDyadic);
  EXPECT_EQ(gof.pattern.period_log2, 2);
  EXPECT_EQ(gof.pattern.temporal_layers, 2U);
  EXPECT_FALSE(gof.exact_flag);
  EXPECT_EQ(gof.step, (std::vector<std::uint32_t>{21, 32, 65536}));
  EXPECT_EQ(gof.first_step, 21U);
  EXPECT_EQ(gof.weights, (WeightSettings{6, 3, 11, 0}));
  EXPECT_TRUE(gof.learning_flag);
  EXPECT_EQ(gof.prime_log2, 5);
  EXPECT_TRUE(gof.frame_hash_flag);
  EXPECT_EQ(gof.max_earlier_distance, 2U);
  EXPECT_EQ(gof.layer_group_size, (std::vector<std::uint32_t>{2, 1}));
  EXPECT_EQ(gof.layer_step, (std::vector<std::uint8_t>{16, 10, 2}));
  EXPECT_EQ(gof.rest, RestSettings{});
  EXPECT_EQ(gof.num_patches, 3U);
  EXPECT_EQ(gof.patch_of_vertex, (PatchOfVertex{2, 2, 0, 0, 0, 0, 1, 1, 1}));

  const InterGof other = parsed(kExplicit);
  EXPECT_EQ(other.pattern.kind, FramePattern::kExplicit);
  EXPECT_EQ(other.pattern.entries,
            (std::vector<PatternEntry>{{3, {0, 0}, 0}, {1, {0, 3}, 1}, {2, {1, 1}, 3}}));
  EXPECT_EQ(other.pattern.temporal_layers, 3U);
  EXPECT_TRUE(other.exact_flag);
  EXPECT_EQ(other.step, std::vector<std::uint32_t>(4, kExactInterStep));
  EXPECT_EQ(other.first_step, kExactInterStep);
  EXPECT_EQ(other.weights, (WeightSettings{1, 15, 0, 0}));
  EXPECT_FALSE(other.learning_flag);
  EXPECT_EQ(other.layer_group_size, std::vector<std::uint32_t>{3});
  EXPECT_EQ(other.layer_step, std::vector<std::uint8_t>(3, 16));
  EXPECT_EQ(other.rest, (RestSettings{true, true, 63, 1, true, true}));
  EXPECT_TRUE(other.patch_of_vertex.empty());
}

Residuals residuals_of(const InterFrame& frame) {
  Residuals list;
  for (std::size_t i = 0; i < frame.residual.size(); ++i) list.push_back(frame.residual[i]);
  return list;
}

// Vertices are in the layers {2, 3, 6, 7}, {1} and {0, 4, 5, 8}. `expected` is FrameNoise, as
// specdec computes it.
TEST(ParseInterGof, FillsTheFramesOfADyadicPattern) {
  const InterGof gof = parsed(kDyadic);
  const std::vector<InterFrame>& frames = *gof.frames;
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[0].layer_groups, 2U);
  EXPECT_EQ(frames[0].frame_crc->crc, 0x12345678U);
  EXPECT_EQ(frames[0].frame_crc->bit_pos, kPayloadBitPos + 8);
  EXPECT_EQ(residuals_of(frames[0]),
            (Residuals{1, 0, -2, 1, 4,    -3, 40, -20, 7,  3, 1, -1, 3, 0,
                       1, 5, -1, 0, 2000, -5, 6,  9,   -8, 0, 2, 2,  -1}));
  EXPECT_EQ(frames[0].expected,
            (std::vector<std::uint16_t>{54, 761, 16, 144, 841, 760, 87, 1023, 1023}));
  EXPECT_TRUE(frames[0].patches.empty());

  EXPECT_EQ(frames[4].layer_groups, 2U);
  EXPECT_EQ(frames[4].frame_crc->crc, 1U);
  ASSERT_EQ(frames[4].patches.size(), 3U);
  EXPECT_EQ(frames[4].patches[0], PatchMotion{});
  EXPECT_EQ(frames[4].patches[1],
            (PatchMotion{PatchMode::kMotion, {12, -7, 3, 1, 0, 0, -2, 1, 0, 0, 5, -1}}));
  EXPECT_EQ(frames[4].patches[2],
            (PatchMotion{PatchMode::kAlone, {4, 0, 0, 300, -1, 0, 0, 2, 0, 0, -9, 1}}));
  // Vertices 0 and 1 are in patch 2.
  EXPECT_EQ(residuals_of(frames[4]), (Residuals{0, 0, 0, 0, 0, 0, 3, 0, -1, 1, 2, 0, -1, 0,
                                                2, 2, 2, 2, 0, 0, 0, 0, 0,  0, 2, 2, 2}));
  EXPECT_EQ(frames[4].expected, (std::vector<std::uint16_t>{0, 0, 9, 11, 6, 6, 10, 8, 6}));

  EXPECT_EQ(frames[2].reference, 0U);
  EXPECT_FALSE(frames[2].repeated);
  EXPECT_EQ(frames[2].expected, (std::vector<std::uint16_t>{5, 4, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(frames[2].patches[2].mode, PatchMode::kMotion);

  EXPECT_EQ(frames[1].repeated, 2U);
  EXPECT_EQ(frames[1].layer_groups, 2U);
  EXPECT_FALSE(frames[1].frame_crc);
  EXPECT_TRUE(frames[1].patches.empty());
  EXPECT_TRUE(residuals_of(frames[1]).empty());

  EXPECT_EQ(frames[3].layer_groups, 1U);
  EXPECT_FALSE(frames[3].reference);
  EXPECT_FALSE(frames[3].frame_crc);
  EXPECT_EQ(residuals_of(frames[3]),
            (Residuals{0, 0, 0, 0, 0,  0,  0,  0,  -1, -1, -1, -1, 0, 0,
                       0, 0, 0, 0, -1, -1, -1, -1, -1, -1, 0,  0,  0}));
}

TEST(ParseInterGof, FillsTheFramesOfAnExplicitPattern) {
  const InterGof gof = parsed(kExplicit);
  const std::vector<InterFrame>& frames = *gof.frames;
  ASSERT_EQ(frames.size(), 7U);
  EXPECT_EQ(residuals_of(frames[0]),
            (Residuals{40, -20, 7, 3,  1,  -1, 20, -5, 6,  9,  -8, 0,  -3, -3,
                       -3, 1,   4, -3, -3, -3, -3, -3, -3, -3, -3, -3, -3}));
  ASSERT_EQ(frames[0].counterparts.size(), 9U);
  EXPECT_EQ(frames[0].counterparts[4], (Counterpart{false, true, true, 0, 0}));
  EXPECT_EQ(frames[0].counterparts[6], Counterpart{});
  EXPECT_EQ(frames[0].counterparts[7], (Counterpart{true, false, false, 0, 0}));
  EXPECT_EQ(residuals_of(frames[3])[6], 3);  // vertex 2 comes first
  EXPECT_EQ(residuals_of(frames[1])[6], 5);
  EXPECT_EQ(frames[6].repeated, 3U);
  EXPECT_EQ(frames[4].reference, 6U);
  EXPECT_EQ(frames[5].repeated, 4U);
  EXPECT_EQ(residuals_of(frames[2]), Residuals(27, 1));
  EXPECT_EQ(frames[2].expected, std::vector<std::uint16_t>(9, 9));
  EXPECT_EQ(frames[4].expected, (std::vector<std::uint16_t>{3, 3, 22, 10, 3, 3, 3, 3, 3}));
  for (const InterFrame& frame : frames) EXPECT_EQ(frame.layer_groups, 1U);
}

TEST(ParseInterGof, SaysWhichUnitItWas) {
  InterGofUnits units = units_of(kDyadic);
  ASSERT_TRUE(units.gof(kDyadic.units[0]));
  // frame_idx, layer_group_idx, temporal layer
  const std::uint32_t expected[][3] = {{0, 0, 0}, {0, 1, 0}, {4, 0, 0}, {4, 1, 0},
                                       {2, 0, 0}, {2, 1, 0}, {1, 0, 1}, {3, 0, 1}};
  const std::uint32_t complete[] = {0, 1, 1, 2, 2, 3, 4, 4};
  for (std::size_t i = 0; i < 8; ++i) {
    ASSERT_TRUE(units.frame(kDyadic.units[i + 1]));
    const auto& last = units.parser().last_unit();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->frame_idx, expected[i][0]);
    EXPECT_EQ(last->layer_group_idx, expected[i][1]);
    EXPECT_EQ(last->temporal_layer_idx, expected[i][2]);
    EXPECT_EQ(last->num_frames, 1U);
    EXPECT_FALSE(last->is_gof_end);
    EXPECT_EQ(units.parser().complete_places(), complete[i]) << i;
  }
  InterGofUnits others = units_of(kExplicit);
  ASSERT_TRUE(others.gof(kExplicit.units[0]));
  const std::uint32_t num_frames[] = {2, 3, 2};
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(others.frame(kExplicit.units[i + 1]));
    EXPECT_EQ(others.parser().last_unit()->num_frames, num_frames[i]);
    EXPECT_EQ(others.parser().last_unit()->temporal_layer_idx, i == 2 ? 2U : 0U);
  }
}

// Copies have the exact size. A section that is cut off could be one of smaller residuals; here
// none is.
TEST(ParseInterGof, EveryProperPrefixIsTruncatedOrHasAWrongEnd) {
  for (const LegalGof& gof : kLegalGofs) {
    for (std::size_t unit = 0; unit < gof.units.size(); ++unit) {
      const Bytes& whole = gof.units[unit];
      ElementPlaces places;
      ASSERT_TRUE(parse_unit(gof, unit, whole, &places));
      for (std::size_t n = 0; n < whole.size(); ++n) {
        SCOPED_TRACE(testing::Message() << "unit " << unit << ", " << n << " bytes");
        const Bytes exact(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
        const auto cut = parse_unit(gof, unit, exact);
        ASSERT_FALSE(cut);
        if (n < gof.section_start[unit]) {
          const auto& [bit_pos, element] = places.cut_off_at(n);
          EXPECT_EQ(cut.error().code, Errc::kTruncated);
          EXPECT_STREQ(cut.error().rule, "R-BIT-01");
          EXPECT_EQ(cut.error().element, element);
          EXPECT_EQ(cut.error().bit_pos, kPayloadBitPos + bit_pos);
        } else {
          EXPECT_EQ(cut.error().code, Errc::kInvalid);
          EXPECT_STREQ(cut.error().rule, "R-RNG-01");
          EXPECT_GE(cut.error().bit_pos, kPayloadBitPos + 8 * gof.section_start[unit]);
        }
      }
    }
  }
}

// Returns whether a unit has a section, or ends with its fixed elements.
bool has_section(const LegalGof& gof, std::size_t unit) {
  return gof.section_start[unit] < gof.units[unit].size();
}
const char* name_of_section(std::size_t unit) {
  return unit == 0 ? "patch_map" : "frame_section";
}

TEST(ParseInterGof, SurplusBytesFail) {
  for (const LegalGof& gof : kLegalGofs) {
    for (std::size_t unit = 0; unit < gof.units.size(); ++unit) {
      Bytes longer = gof.units[unit];
      longer.push_back(0);
      const auto ok = parse_unit(gof, unit, longer);
      if (has_section(gof, unit)) {
        expect_invalid(ok, "R-RNG-01", name_of_section(unit));
      } else {
        expect_invalid_at(ok, "R-BIT-03", "unit_payload", 8 * gof.units[unit].size());
      }
    }
  }
}

TEST(ParseInterGof, SectionsMustNotStartWithOnes) {
  for (const LegalGof& gof : kLegalGofs) {
    for (std::size_t unit = 0; unit < gof.units.size(); ++unit) {
      if (!has_section(gof, unit)) continue;
      Bytes wrong(
          gof.units[unit].begin(),
          gof.units[unit].begin() + static_cast<std::ptrdiff_t>(gof.section_start[unit]));
      wrong.insert(wrong.end(), 4, 0xFF);
      expect_invalid(parse_unit(gof, unit, wrong), "R-RNG-02", name_of_section(unit));
    }
  }
}

TEST(ParseInterGof, AlignmentIsZero) {
  // The first alignment bit of each unit; a multiple of 8 if there is none.
  const std::vector<std::vector<std::uint64_t>> at{{125, 3, 5, 8, 9, 10, 7, 8, 8},
                                                   {106, 6, 16, 11}};
  for (std::size_t g = 0; g < kLegalGofs.size(); ++g) {
    const LegalGof& gof = kLegalGofs[g];
    for (std::size_t unit = 0; unit < gof.units.size(); ++unit) {
      const std::uint64_t first = at[g][unit];
      for (std::uint64_t bit = first; bit % 8 != 0; ++bit) {
        Bytes wrong = gof.units[unit];
        wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] | 0x80U >> (bit % 8));
        expect_invalid_at(parse_unit(gof, unit, wrong), "R-BIT-02", "alignment_zero_bits",
                          first);
      }
    }
  }
}

TEST(ParseInterGof, NoByteMakesItCrash) {
  for (const LegalGof& gof : kLegalGofs) {
    for (std::size_t unit = 0; unit < gof.units.size(); ++unit) {
      for (std::size_t i = 0; i < gof.units[unit].size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
          Bytes damaged = gof.units[unit];
          damaged[i] = static_cast<std::uint8_t>(damaged[i] ^ (1 << bit));
          const auto ok = parse_unit(gof, unit, damaged);
          if (ok || ok.error().code == Errc::kTruncated) continue;
          EXPECT_STRNE(ok.error().element, "");
        }
      }
    }
  }
}

// Shared rigs that are alive take memory while an inter GOF is parsed, which uses none of them.
TEST(ParseInterGof, CountsTheRigsThatAreAlive) {
  RigSlots rigs;
  auto rig = std::make_shared<SharedRig>();
  rig->influences.resize(1000);
  rigs.slots[3] = rig;
  InterGofUnits without = units_of(kDyadic);
  InterGofUnits with = units_of(kDyadic);
  ASSERT_TRUE(without.gof(kDyadic.units[0]));
  BitReader r(kDyadic.units[0], kPayloadBitPos);
  const GofHeader header = parse_gof_header(r, high_header(9, kDyadic.num_frames), 0);
  ASSERT_TRUE(with.parser().gof(r, header, rigs));
  EXPECT_EQ(with.parser().memory_bytes(),
            without.parser().memory_bytes() + memory_of_rigs(rigs));
}

}  // namespace
}  // namespace rlpc
