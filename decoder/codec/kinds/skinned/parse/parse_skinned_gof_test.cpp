#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/element_names.h"
#include "decoder/codec/parse/rig_memory.h"
#include "decoder/testing/skinned_gof_units.h"

namespace rlpc {
namespace {

// Written by rlpcgen, from the specification. The elements are listed in the first test.
const Bytes kGof{0xA9, 0x07, 0x0C, 0xF2, 0x38, 0x4B, 0xE4, 0x40, 0x80, 0x00, 0x3F, 0xFF,
                 0x40, 0x00, 0x30, 0xA4, 0x00, 0x0F, 0x58, 0x00, 0x0D, 0xC4, 0xCC, 0x00,
                 0x02, 0xFF, 0xFF, 0x80, 0x00, 0x0F, 0xBE, 0x27, 0x8D, 0x5C, 0x90, 0x05,
                 0xE7, 0x2E, 0x87, 0x7E, 0xC0, 0x00, 0x0A, 0x16, 0x0E, 0x11, 0xD2, 0x4B,
                 0x5A, 0x18, 0xE5, 0x04, 0xEE, 0xC9, 0x5D, 0x3E};
const Bytes kRest{0xC0, 0x2C, 0x8E, 0x18, 0xC2, 0x39, 0x59, 0xC5,
                  0x20, 0xF4, 0x21, 0xE3, 0xBE, 0xE1, 0xCE, 0xF5};
const Bytes kRestFiner{0xA0, 0xEF, 0x43, 0xCB, 0x05, 0x7B, 0x60, 0xBA, 0x47};
const Bytes kGroup{0x50, 0x40, 0x00, 0x56, 0x40, 0x74, 0xCC, 0x88, 0xA6,
                   0xC3, 0xAD, 0x28, 0x6A, 0x4D, 0x0A, 0x91, 0x92, 0xA0,
                   0xCB, 0x75, 0x2D, 0x9E, 0xFA, 0x8B, 0x00, 0xBB, 0xEC};
const Bytes kGroupFiner{0x48, 0xB1, 0x60, 0x47, 0x87};

const Bytes kThird{0x70, 0xFD, 0x98, 0xFD, 0x76, 0x3F, 0x1F, 0x3F};
const std::vector<Bytes> kSlices{kRest, kRestFiner, kGroup, kGroupFiner, kThird};

SkinnedGofUnits legal_units(std::uint64_t max_memory_bytes = std::uint64_t{1} << 30) {
  return SkinnedGofUnits(main_header(9, 5), kSquares, max_memory_bytes);
}

TEST(ParseSkinnedGof, GivesTheElements) {
  SkinnedGofUnits units = legal_units();
  const std::vector<std::pair<Bytes, std::string>> list{
      {kGof,
       "first_frame 0\nnum_gof_frames_minus1 1\nbones_flag 1\nnum_bones_minus1 3\n"
       "fraction_bits 3\nweight_bits 4\nrest_step_minus1 5\nnum_component_groups 2\n"
       "prediction_idc 3\ndamping_log2 2\nouter_weight 3\nouter_scale 8\n"
       "num_layer_groups_minus1 1\nlayer_group_layers_minus1 1\n"
       "layer_step_minus1 15 9 1\nbone_pivot 65536 65537 1\nrotation_flag 0\n"
       "origin_flag 1\norigin_step_idx 20\norigin_order 0\n"
       "origin_residual 40 -20 7 1 0 0\nbone_parent_plus1 0\nbone_pivot 2 131071 0\n"
       "rotation_flag 1\norigin_flag 0\nrotation_step_idx 239\n"
       "rotation_order_minus1 0\nrotation_residual 3 -1 0 2 0 0\nbone_parent_plus1 2\n"
       "bone_pivot 65536 65500 70000\nrotation_flag 1\norigin_flag 1\n"
       "rotation_step_idx 0\nrotation_order_minus1 3\nrotation_residual -7 1 0 0 0 1\n"
       "origin_step_idx 239\norigin_order 4\norigin_residual 0 -3 2 0 1 0\n"
       "bone_parent_plus1 3\nbone_pivot 5 6 7\nrotation_flag 0\norigin_flag 0"},
      {kRest,
       "component_group_idx 0\nlayer_group_idx 0\nextra_bone_flag 1\nextra_bone 1\n"
       "extra_bone_weight_minus1 6\nextra_bone_flag 1\nextra_bone 2\n"
       "extra_bone_weight_minus1 3\nextra_bone_flag 0\nvertex_residual -4 -3 -5\n"
       "extra_bone_flag 0\nweight_residual 1 1\nvertex_residual -2 -3 6\n"
       "extra_bone_flag 0\nweight_residual 1 1\nvertex_residual -6 -6 1\n"
       "extra_bone_flag 0\nweight_residual 1 1\nvertex_residual 6 -2 -1\n"
       "extra_bone_flag 0\nweight_residual 1 1\nvertex_residual 5 3 4"},
      {kRestFiner,
       "component_group_idx 0\nlayer_group_idx 1\nextra_bone_flag 0\n"
       "weight_residual 0 2\nvertex_residual -2 1 -1\nextra_bone_flag 1\n"
       "extra_bone 3\nextra_bone_weight_minus1 0\nweight_residual 0 0\n"
       "vertex_residual -2 -3 2\nextra_bone_flag 0\nweight_residual 0 0\n"
       "vertex_residual -1 0 1\nextra_bone_flag 0\nweight_residual 0 0\n"
       "vertex_residual 1 0 0"},
      {kGroup,
       "component_group_idx 1\nlayer_group_idx 0\nnum_group_components_minus1 1\n"
       "scale_idx_delta 24\nspatial_bits_delta 12\ntemporal_bits_delta 11\n"
       "temporal_predictor 7\ntemporal_weight 320 200 0\n"
       "trajectory_residual 30 -9 4 0 0 2\nscale_idx_delta -4\nspatial_bits_delta -4\n"
       "temporal_bits_delta 0\ntemporal_predictor 2\n"
       "trajectory_residual 1 0 -1 0 0 1\nvertex_residual 3 6 1 0 4 -8 -9 0 1 0"},
      {kGroupFiner,
       "component_group_idx 1\nlayer_group_idx 1\nvertex_residual 1 2 2 1 0 1 0 2"},
      {kThird,
       "component_group_idx 2\nlayer_group_idx 0\nnum_group_components_minus1 0\n"
       "scale_idx_delta 0\nspatial_bits_delta 0\ntemporal_bits_delta -1\n"
       "temporal_predictor 5\ntemporal_weight 300\ntrajectory_residual -2 0 0 1 0 0\n"
       "vertex_residual 2 -1 0 0 1"},
  };
  for (const auto& [payload, text] : list) {
    ElementNames names;
    const auto parsed =
        &payload == &list[0].first ? units.gof(payload, &names) : units.slice(payload, &names);
    ASSERT_TRUE(parsed) << parsed.error().rule << ' ' << parsed.error().element;
    EXPECT_EQ(names.text, text);
    EXPECT_TRUE(names.in_order);
  }
}

TEST(ParseSkinnedGof, FillsTheStructure) {
  SkinnedGofUnits units = legal_units();
  ASSERT_TRUE(units.gof(kGof));
  for (const Bytes& slice : kSlices) ASSERT_TRUE(units.slice(slice));
  EXPECT_FALSE(units.parser().is_cut());
  const SkinnedGof gof = units.parser().finish();
  EXPECT_EQ(gof.kind, GofKind::kSkinned);
  EXPECT_EQ(gof.num_frames, 2U);
  EXPECT_EQ(gof.fraction_bits, 3);
  EXPECT_EQ(gof.weight_bits, 4);
  EXPECT_EQ(gof.rest_step, 6U);
  EXPECT_EQ(gof.num_component_groups, 2U);
  EXPECT_EQ(gof.prediction, Prediction::kLayers);
  EXPECT_EQ(gof.weights.damping_log2, 2);
  EXPECT_EQ(gof.weights.outer_weight, 3);
  EXPECT_EQ(gof.weights.outer_scale, 8);
  EXPECT_EQ(gof.layer_group_size, (std::vector<std::uint32_t>{2, 1}));
  EXPECT_EQ(gof.layer_step, (std::vector<std::uint8_t>{16, 10, 2}));

  ASSERT_EQ(gof.bones.size(), 4U);
  EXPECT_EQ(gof.bones[0].parent, -1);
  EXPECT_EQ(gof.bones[0].pivot, (Vec3i{0, 1, -65535}));  // 17 bits, with an offset of 2^16
  EXPECT_FALSE(gof.bones[0].rotation_flag);
  EXPECT_TRUE(gof.bones[0].origin_flag);
  EXPECT_EQ(gof.bones[0].origin_step_idx, 20U);
  EXPECT_EQ(gof.bones[0].origin_residual, (TrackResiduals{{40, -20, 7}, {1, 0, 0}}));
  EXPECT_EQ(gof.bones[1].parent, -1);
  EXPECT_EQ(gof.bones[1].rotation_step_idx, 239U);
  EXPECT_EQ(gof.bones[1].rotation_order, 1);
  EXPECT_TRUE(gof.bones[1].origin_residual.empty());
  EXPECT_EQ(gof.bones[2].parent, 1);
  EXPECT_EQ(gof.bones[2].rotation_order, 4);
  EXPECT_EQ(gof.bones[2].origin_order, 4);
  EXPECT_EQ(gof.bones[2].origin_residual, (TrackResiduals{{0, -3, 2}, {0, 1, 0}}));
  EXPECT_EQ(gof.bones[3].parent, 2);

  EXPECT_EQ(gof.group_end, (std::vector<std::size_t>{3, 5, 6}));
  EXPECT_EQ(gof.slice_layers, (std::vector<std::uint32_t>{2, 2, 1}));
  ASSERT_EQ(gof.trajectories.size(), 3U);
  EXPECT_EQ(gof.trajectories[0].scale_idx, 24);
  EXPECT_EQ(gof.trajectories[0].temporal_weight, (std::array<std::int16_t, 3>{64, -56, -256}));
  EXPECT_EQ(gof.trajectories[1].scale_idx, 20);
  EXPECT_EQ(gof.trajectories[1].spatial_bits, 9);
  EXPECT_EQ(gof.trajectories[1].temporal_bits, 12);
  EXPECT_EQ(gof.trajectories[1].temporal_predictor, 2);
  EXPECT_EQ(gof.trajectories[1].residual, (TrackResiduals{{1, 0, -1}, {0, 0, 1}}));
  EXPECT_EQ(gof.trajectories[2].scale_idx, 20);
  EXPECT_EQ(gof.trajectories[2].spatial_bits, 9);
  EXPECT_EQ(gof.trajectories[2].temporal_bits, 11);
  EXPECT_EQ(gof.trajectories[2].temporal_weight, (std::array<std::int16_t, 3>{44, 0, 0}));
}

// The layers are {2, 3, 6, 1, 8} and {0, 4, 5, 7}.
TEST(ParseSkinnedGof, PutsVerticesWhereTheyBelong) {
  SkinnedGofUnits units = legal_units();
  ASSERT_TRUE(units.gof(kGof));
  for (const Bytes& slice : kSlices) ASSERT_TRUE(units.slice(slice));
  const SkinnedGof gof = units.parser().finish();
  ASSERT_EQ(gof.vertex_residual.size(), 3U);
  EXPECT_EQ(gof.vertex_residual[0],
            (std::vector<std::int32_t>{-2, 1,  -1, 5, 3,  4,  -4, -3, -5, -2, -3, 6, -2, -3,
                                       2,  -1, 0,  1, -6, -6, 1,  6,  -2, -1, 1,  0, 0}));
  // The first vertex has two extra bones, and the remaining weight goes to bone 0.
  ASSERT_EQ(gof.influences[2].size, 3);
  EXPECT_EQ(gof.influences[2].list[0], (Influence{1, 7}));
  EXPECT_EQ(gof.influences[2].list[1], (Influence{2, 4}));
  EXPECT_EQ(gof.influences[2].list[2], (Influence{0, 5}));
  ASSERT_EQ(gof.influences[4].size, 4);
  EXPECT_EQ(gof.influences[4].list[0], (Influence{3, 1}));
  for (const Influences& influences : gof.influences) {
    int sum = 0;
    for (const Influence& influence : influences) sum += influence.weight;
    EXPECT_EQ(sum, 16);
  }
}

TEST(ParseSkinnedGof, TellsWhichSliceItWas) {
  SkinnedGofUnits units = legal_units();
  ASSERT_TRUE(units.gof(kGof));
  const std::uint32_t expected[][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 2}, {1, 1, 0}, {2, 0, 1}};
  for (std::size_t i = 0; i < kSlices.size(); ++i) {
    ASSERT_TRUE(units.slice(kSlices[i]));
    const auto& last = units.parser().last_slice();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->component_group_idx, expected[i][0]);
    EXPECT_EQ(last->layer_group_idx, expected[i][1]);
    EXPECT_EQ(last->num_trajectories, expected[i][2]);
  }
}

// 8.14.1: groups are in order, layer groups begin with the coarsest, and a group has no layer
// group that the previous group lacks.
TEST(ParseSkinnedGof, SlicesFollowEachOther) {
  const std::vector<Bytes> slices{kThird, kRest, kRestFiner, kGroup, kGroupFiner};
  struct Order {
    std::vector<std::size_t> before;
    std::size_t next;
  };
  const std::vector<Order> legal{{{}, 1},        {{1}, 2},         {{1}, 3},
                                 {{1, 2}, 3},    {{1, 3}, 0},      {{1, 2, 3}, 4},
                                 {{1, 2, 3}, 0}, {{1, 2, 3, 4}, 0}};
  const std::vector<Order> illegal{
      {{}, 0},          {{}, 2},        {{}, 3},        {{}, 4},           {{1}, 0},
      {{1}, 1},         {{1}, 4},       {{1, 2}, 0},    {{1, 2}, 1},       {{1, 2}, 2},
      {{1, 2}, 4},      {{1, 3}, 1},    {{1, 3}, 2},    {{1, 3}, 3},       {{1, 3}, 4},
      {{1, 2, 3}, 2},   {{1, 2, 3}, 3}, {{1, 3, 0}, 2}, {{1, 2, 3, 4}, 4}, {{1, 2, 3, 0}, 4},
      {{1, 2, 3, 0}, 0}};
  for (const auto* list : {&legal, &illegal}) {
    for (const auto& [before, next] : *list) {
      SkinnedGofUnits units = legal_units();
      ASSERT_TRUE(units.gof(kGof));
      for (const std::size_t i : before) ASSERT_TRUE(units.slice(slices[i]));
      const auto parsed = units.slice(slices[next]);
      if (list == &legal) {
        EXPECT_TRUE(parsed) << before.size() << ' ' << next;
      } else {
        expect_invalid(parsed, "R-SLI-02", "slice_unit");
        EXPECT_EQ(parsed.error().bit_pos, kUnitBitPos);
      }
    }
  }
}

// Parses a unit after the preceding units, whose bytes are valid.
Result<bool> parse_unit(std::size_t unit, const Bytes& payload) {
  SkinnedGofUnits units = legal_units();
  if (unit == 0) return units.gof(payload);
  EXPECT_TRUE(units.gof(kGof));
  for (std::size_t i = 1; i < unit; ++i) EXPECT_TRUE(units.slice(kSlices[i - 1]));
  return units.slice(payload);
}

const Bytes& unit_payload(std::size_t unit) { return unit == 0 ? kGof : kSlices[unit - 1]; }
constexpr std::size_t kUnits = 6;
constexpr std::size_t kSectionStart[kUnits] = {8, 1, 1, 1, 1, 1};

// Parses exact-size copies. A section that is cut off could be a section of smaller residuals;
// here none is.
TEST(ParseSkinnedGof, EveryProperPrefixFails) {
  for (std::size_t unit = 0; unit < kUnits; ++unit) {
    const Bytes& whole = unit_payload(unit);
    ASSERT_TRUE(parse_unit(unit, whole));
    for (std::size_t n = 0; n < whole.size(); ++n) {
      const Bytes exact(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
      const auto parsed = parse_unit(unit, exact);
      ASSERT_FALSE(parsed) << unit << ' ' << n;
      if (n < kSectionStart[unit]) {
        EXPECT_EQ(parsed.error().code, Errc::kTruncated) << unit << ' ' << n;
      } else {
        EXPECT_EQ(parsed.error().code, Errc::kInvalid) << unit << ' ' << n;
      }
    }
  }
}

TEST(ParseSkinnedGof, SurplusBytesFail) {
  for (std::size_t unit = 0; unit < kUnits; ++unit) {
    Bytes longer = unit_payload(unit);
    longer.push_back(0);
    expect_invalid(parse_unit(unit, longer), "R-RNG-01",
                   unit == 0 ? "bone_section" : "slice_section");
  }
}

TEST(ParseSkinnedGof, SectionsMustNotStartWithOnes) {
  for (std::size_t unit = 0; unit < kUnits; ++unit) {
    Bytes wrong = unit_payload(unit);
    std::fill_n(wrong.begin() + static_cast<std::ptrdiff_t>(kSectionStart[unit]), 4,
                std::uint8_t{0xFF});
    expect_invalid(parse_unit(unit, wrong), "R-RNG-02",
                   unit == 0 ? "bone_section" : "slice_section");
  }
}

TEST(ParseSkinnedGof, AlignmentIsZero) {
  for (std::size_t unit = 0; unit < kUnits; ++unit) {
    Bytes wrong = unit_payload(unit);
    wrong[kSectionStart[unit] - 1] |= 1;
    expect_invalid(parse_unit(unit, wrong), "R-BIT-02", "alignment_zero_bits");
  }
}

// Adds the vertices with rest positions and bones, then one trajectory and two more; the
// section that is read comes on top.
TEST(ParseSkinnedGof, FactorsStayWithinTheMemoryOfTheCaller) {
  constexpr std::uint64_t kBones =
      memory_of_vertices(9, false) + memory_of_spatial(9, 3) + memory_of_tracks(48);
  constexpr std::uint64_t kTrajectory =
      memory_of_trajectories(1) + memory_of_spatial(9, 1) + memory_of_tracks(6);
  struct Case {
    std::size_t unit;
    std::uint64_t bytes;
    const char* element;
  };
  const Case cases[] = {{0, kBones, "bone_section"},
                        {3, kBones + 2 * kTrajectory, "num_group_components_minus1"},
                        {5, kBones + 3 * kTrajectory, "num_group_components_minus1"}};
  for (const auto& [unit, bytes, element] : cases) {
    SCOPED_TRACE(unit);
    const auto parse = [&, last = unit](std::uint64_t max_bytes) {
      SkinnedGofUnits units = legal_units(max_bytes);
      Result<bool> parsed = units.gof(kGof);
      for (std::size_t i = 0; parsed && i < last; ++i) parsed = units.slice(kSlices[i]);
      return parsed;
    };
    const auto too_little = parse(bytes);
    ASSERT_FALSE(too_little);
    EXPECT_EQ(too_little.error().code, Errc::kLimitExceeded);
    EXPECT_STREQ(too_little.error().element, element);
    const std::uint64_t needed = too_little.error().needed_bytes;
    EXPECT_GT(needed, bytes);
    EXPECT_LT(needed, bytes + unit_payload(unit).size());
    EXPECT_TRUE(parse(needed));
    EXPECT_FALSE(parse(needed - 1));
  }
}

}  // namespace
}  // namespace rlpc
