// Elements of 6.14 up to the ends of their ranges, and beyond.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/inter_gof_recipe.h"
#include "decoder/codec/kinds/inter/parse/inter_memory.h"
#include "decoder/testing/inter_gof_units.h"

namespace rlpc {
namespace {

Result<bool> parse_gof(const InterGofRecipe& recipe, InterGofUnits& units) {
  return units.gof(recipe.payload());
}
Result<bool> parse_gof(const InterGofRecipe& recipe) {
  InterGofUnits units(high_header(9, 40), kSquares);
  return parse_gof(recipe, units);
}
InterGof settings_of(const InterGofRecipe& recipe) {
  InterGofUnits units(high_header(9, 40), kSquares);
  EXPECT_TRUE(parse_gof(recipe, units));
  return units.parser().finish();
}

// Returns a section in which all vertices are in this patch.
Bytes patch_map_of(std::uint32_t num_patches, std::uint32_t patch) {
  SectionRecipe r;
  ClusterMapModels models;
  models.cluster_idx.resize(std::size_t{1} << ceil_log2(num_patches));
  const Topology topology = make_topology(9, kSquares);
  for (std::uint32_t v = 0; v < 9 && num_patches > 1; ++v) {
    const std::size_t context = topology.earlier_neighbours[v].empty() ? 0 : 1;
    r.section.bin(models.cluster_predicted_flag[context], v > 0);
    if (v > 0) continue;
    std::uint32_t node = 1;
    for (int bit = ceil_log2(num_patches) - 1; bit >= 0; --bit) {
      const bool digit = (patch >> bit & 1U) != 0;
      r.section.bin(models.cluster_idx[node], digit);
      node = 2 * node + (digit ? 1 : 0);
    }
  }
  return r.section.finish();
}

// The bits of the default recipe are: up to num_gof_frames_minus1 6, gof_kind 2,
// frame_pattern_idc 2, exact_flag 1, frame_step_minus1 9, weights 12, learning_flag 1,
// frame_hash_flag 1, max_earlier_distance 1, num_layer_groups_minus1 1, layer_step_minus1 12,
// rest_order_flag 1, rest_step_minus1 9, frame_step_delta_flag 1, num_patches 1.
struct Bound {
  const char* rule;
  const char* element;
  std::uint64_t bit_pos;
  std::uint32_t max;
  std::function<void(InterGofRecipe&, std::uint32_t)> set;
};

TEST(ParseInterGofRanges, ElementsAreTakenUpToTheirBoundsAndNotBeyond) {
  const std::vector<Bound> bounds{
      {"R-FRM-01", "frame_step_minus1", 11, 65535,
       [](auto& r, auto v) { r.frame_step_minus1 = {v}; }},
      {"R-FRM-01", "frame_step_minus1", 35, 65535,
       [](auto& r, auto v) {
         r.pattern = FramePatternRecipe::dyadic(2, 0);
         r.frame_step_minus1 = {15, 15, v};
       }},
      // 2^23 factors, 27 coordinates in a frame
      {"R-LVL-05", "max_earlier_distance", 34, 310689,
       [](auto& r, auto v) { r.max_earlier_distance = v; }},
      {"R-BON-03", "num_layer_groups_minus1", 35, 2,
       [](auto& r, auto v) {
         r.num_layer_groups_minus1 = v;
         r.layer_group_layers_minus1.assign(v, 0);
       }},
      {"R-BON-03", "layer_group_layers_minus1", 38, 1,
       [](auto& r, auto v) {
         r.num_layer_groups_minus1 = 1;
         r.layer_group_layers_minus1 = {v};
       }},
      {"R-BON-03", "layer_group_layers_minus1", 38, 0,
       [](auto& r, auto v) {
         r.num_layer_groups_minus1 = 2;
         r.layer_group_layers_minus1 = {v, 0};
       }},
      {"R-BON-03", "layer_group_layers_minus1", 39, 0,
       [](auto& r, auto v) {
         r.num_layer_groups_minus1 = 2;
         r.layer_group_layers_minus1 = {0, v};
       }},
      {"R-LVL-06", "num_patches", 59, 256,
       [](auto& r, auto v) {
         r.num_patches = v;
         r.patch_map = patch_map_of(v, 0);
       }},
      {"R-FRM-01", "rest_step_minus1", 49, 65535,
       [](auto& r, auto v) { r.rest_step_minus1 = v; }},
      {"R-FRM-05", "pattern_period_log2", 10, 6,
       [](auto& r, auto v) {
         r.pattern = FramePatternRecipe::dyadic(v, 0);
         r.frame_step_minus1.assign(v + 1, 0);
       }},
      {"R-FRM-07", "temporal_layers_minus1", 13, 3,
       [](auto& r, auto v) {
         r.pattern = FramePatternRecipe::dyadic(3, v);
         r.frame_step_minus1 = {0, 0, 0, 0};
       }},
  };
  for (const Bound& bound : bounds) {
    SCOPED_TRACE(bound.element);
    for (const std::uint32_t less : {1U, 0U}) {
      if (bound.max < less) continue;
      InterGofRecipe recipe;
      bound.set(recipe, bound.max - less);
      const auto ok = parse_gof(recipe);
      EXPECT_TRUE(ok) << ok.error().rule << ' ' << ok.error().element;
    }
    InterGofRecipe recipe;
    bound.set(recipe, bound.max + 1);
    expect_invalid_at(parse_gof(recipe), bound.rule, bound.element, bound.bit_pos);
  }
}

TEST(ParseInterGofRanges, ElementsWithoutBoundsTakeAllValues) {
  for (std::uint32_t v = 0; v < 16; ++v) {
    InterGofRecipe recipe;
    recipe.damping_log2 = v;
    recipe.outer_weight = 15 - v;
    recipe.outer_scale = v ^ 5U;
    recipe.learning_flag = true;
    recipe.prime_log2 = v ^ 9U;
    recipe.frame_hash_flag = v % 2 == 1;
    recipe.layer_step_minus1 = {v, 15 - v, v ^ 1U};
    recipe.frame_step_minus1 = {v * 4369};
    const InterGof gof = settings_of(recipe);
    EXPECT_EQ(gof.weights.damping_log2, static_cast<int>(v));
    EXPECT_EQ(gof.weights.outer_weight, static_cast<int>(15 - v));
    EXPECT_EQ(gof.weights.outer_scale, static_cast<int>(v ^ 5U));
    EXPECT_TRUE(gof.learning_flag);
    EXPECT_EQ(gof.prime_log2, static_cast<int>(v ^ 9U));
    EXPECT_EQ(gof.frame_hash_flag, v % 2 == 1);
    EXPECT_EQ(gof.step, std::vector<std::uint32_t>{v * 4369 + 1});
    EXPECT_EQ(gof.layer_step[0], v + 1);
    EXPECT_EQ(gof.layer_step[1], 16 - v);
    EXPECT_EQ(gof.layer_step[2], (v ^ 1U) + 1);
  }
}

TEST(ParseInterGofRanges, RestOrdersTakeAllWeightsAndFollowTheExactFlag) {
  for (const std::uint32_t weight : {0U, 1U, 31U, 62U, 63U}) {
    for (const bool exact : {false, true}) {
      InterGofRecipe recipe;
      recipe.exact_flag = exact;
      recipe.rest_order_flag = true;
      recipe.rest_edge_weight = weight;
      recipe.rest_ring_weight = 63 - weight;
      recipe.rest_axes_flag = weight % 2 == 1;
      recipe.rest_counterparts_flag = weight > 31;
      EXPECT_EQ(settings_of(recipe).rest,
                (RestSettings{exact, true, static_cast<int>(weight),
                              static_cast<int>(63 - weight), weight % 2 == 1, weight > 31}));
    }
  }
}

// Frames have no order of their own if their layers have several groups.
TEST(ParseInterGofRanges, RestOrdersAreThoseOfOneLayerGroup) {
  InterGofRecipe recipe;
  recipe.num_layer_groups_minus1 = 1;
  recipe.layer_group_layers_minus1 = {0};
  recipe.num_patches = 1;  // 010, which would be rest_order_flag 0 and num_patches 0
  recipe.patch_map = patch_map_of(1, 0);
  const InterGof gof = settings_of(recipe);
  EXPECT_FALSE(gof.rest.order_flag);
  EXPECT_EQ(gof.num_patches, 1U);
  EXPECT_EQ(gof.layer_group_size, (std::vector<std::uint32_t>{1, 2}));
}

TEST(ParseInterGofRanges, ExactPositionsHaveStepsOfOneGridUnit) {
  InterGofRecipe recipe;
  recipe.exact_flag = true;
  recipe.pattern = FramePatternRecipe::dyadic(3, 0);
  const InterGof gof = settings_of(recipe);
  EXPECT_EQ(gof.step, std::vector<std::uint32_t>(4, 16));
  EXPECT_EQ(gof.layer_step, std::vector<std::uint8_t>(3, 16));
}

// B.2: level 1 allows 2^14 vertices times temporal layers.
TEST(ParseInterGofRanges, LearningVerticesAreBoundedByTheLevel) {
  const auto parse_learning = [](std::uint32_t num_vertices, std::uint32_t log2,
                                 std::uint32_t layers, bool learning) {
    InterGofUnits units(high_header(num_vertices, 2));
    InterGofRecipe recipe;
    recipe.num_gof_frames_minus1 = 1;
    recipe.pattern = FramePatternRecipe::dyadic(log2, layers - 1);
    recipe.frame_step_minus1.assign(log2 + 1, 0);
    recipe.layer_step_minus1 = {15};
    recipe.learning_flag = learning;
    return parse_gof(recipe, units);
  };
  EXPECT_TRUE(parse_learning(16384, 1, 1, true));
  EXPECT_TRUE(parse_learning(8192, 1, 2, true));
  EXPECT_TRUE(parse_learning(8193, 1, 2, false));
  EXPECT_TRUE(parse_learning(2340, 6, 7, true));
  // The bits before are: first_frame 1, num_gof_frames_minus1 3, gof_kind 2, pattern 8,
  // exact_flag 1, weights 12, and 1 for each step.
  expect_invalid_at(parse_learning(8193, 1, 2, true), "R-LVL-10", "learning_flag", 29);
  expect_invalid_at(parse_learning(2341, 6, 7, true), "R-LVL-10", "learning_flag", 34);
}

TEST(ParseInterGofRanges, PatchesOfVerticesAreThoseOfTheGof) {
  for (const std::uint32_t num_patches : {1U, 2U, 3U, 5U, 256U}) {
    InterGofRecipe recipe;
    recipe.num_patches = num_patches;
    recipe.patch_map = patch_map_of(num_patches, num_patches - 1);
    const InterGof gof = settings_of(recipe);
    EXPECT_EQ(gof.patch_of_vertex,
              PatchOfVertex(9, static_cast<std::uint16_t>(num_patches - 1)));
    if ((num_patches & (num_patches - 1)) == 0) continue;  // all bits of an index are taken
    recipe.patch_map = patch_map_of(num_patches, num_patches);
    expect_invalid(parse_gof(recipe), "R-GOF-08", "cluster_idx");
  }
}

// The estimate is compared before anything is allocated.
TEST(ParseInterGofRanges, SettingsStayWithinTheMemoryOfTheCaller) {
  InterGofRecipe recipe;
  recipe.learning_flag = true;
  recipe.num_patches = 2;
  recipe.patch_map = patch_map_of(2, 1);
  const std::uint64_t needed = memory_of_frames(9, 5, settings_of(recipe));
  InterGofUnits enough(high_header(9, 40), kSquares, needed);
  EXPECT_TRUE(parse_gof(recipe, enough));
  EXPECT_EQ(enough.parser().memory_bytes(), needed);
  InterGofUnits too_little(high_header(9, 40), kSquares, needed - 1);
  const auto parsed = parse_gof(recipe, too_little);
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, Errc::kLimitExceeded);
  EXPECT_STREQ(parsed.error().element, "frames_of_gof");
  EXPECT_EQ(parsed.error().needed_bytes, needed);
  EXPECT_EQ(parsed.error().bit_pos, kPayloadBitPos + 8);
}

// Frame units of a GOF with one layer group. Residuals are 0.
class Frames {
 public:
  explicit Frames(const InterGofRecipe& recipe, bool open_end = false,
                  std::uint64_t max_memory_bytes = std::uint64_t{1} << 30)
      : units_(header_of(open_end), kSquares, max_memory_bytes),
        contexts_(units_.mesh(), 1, 3) {
    EXPECT_TRUE(units_.gof(recipe.payload()));
    if (open_end) gof_end_flag_ = false;
  }

  FrameRecipe unit(std::uint32_t frame_idx, std::uint32_t num_frames = 1) const {
    FrameRecipe recipe(frame_idx);
    recipe.gof_end_flag = gof_end_flag_;
    recipe.unit_frames_minus1 = num_frames - 1;
    return recipe;
  }
  // Parses a unit; num_coded: frames whose residuals it has, 0 if it is refused before them.
  Result<bool> parse(FrameRecipe recipe, std::uint32_t num_coded) {
    for (const std::uint32_t end = place_ + num_coded; place_ < end; ++place_) {
      contexts_.start_group(place_, 0, 0);
      recipe.zeros(contexts_, units_.mesh().vertices_of_layers(0, 3));
    }
    return units_.frame(recipe.payload());
  }
  InterGofUnits& units() { return units_; }

 private:
  static SequenceHeader header_of(bool open_end) {
    SequenceHeader header = high_header(9, 40);
    header.open_end_flag = open_end;
    return header;
  }

  InterGofUnits units_;
  InterContexts contexts_;
  std::optional<bool> gof_end_flag_;
  std::uint32_t place_ = 0;
};

TEST(ParseFrameUnitRanges, IndicesAreThoseOfTheGof) {
  Frames frames{InterGofRecipe{}};
  for (std::uint32_t f = 0; f < 5; ++f) EXPECT_TRUE(frames.parse(frames.unit(f), 1)) << f;
  expect_invalid_at(frames.parse(frames.unit(5), 0), "R-FRM-02", "frame_idx", 0);
  expect_invalid_at(frames.parse(frames.unit(1000), 0), "R-FRM-02", "frame_idx", 0);
  FrameRecipe wrong = frames.unit(4);
  wrong.layer_group_idx = 1;
  expect_invalid_at(frames.parse(wrong, 0), "R-FRM-02", "layer_group_idx", 5);
}

TEST(ParseFrameUnitRanges, FramesOfAUnitAreThoseOfTheGof) {
  for (const bool open_end : {false, true}) {
    const std::uint64_t at = open_end ? 5 : 4;
    Frames frames(InterGofRecipe{}, open_end);
    EXPECT_TRUE(frames.parse(frames.unit(0, 1), 1));
    expect_invalid_at(frames.parse(frames.unit(1, 5), 0), "R-FRM-09", "unit_frames_minus1", at);
    expect_invalid_at(frames.parse(frames.unit(1, 6), 0), "R-FRM-09", "unit_frames_minus1", at);
    EXPECT_TRUE(frames.parse(frames.unit(1, 4), 4));
    EXPECT_EQ(frames.units().parser().complete_places(), 5U);
  }
  Frames all{InterGofRecipe{}};
  EXPECT_TRUE(all.parse(all.unit(0, 5), 5));
}

InterGofRecipe with_earlier(std::uint32_t max_distance) {
  InterGofRecipe recipe;
  recipe.max_earlier_distance = max_distance;
  return recipe;
}

TEST(ParseFrameUnitRanges, EarlierDistancesAreBoundedByTheGofAndTheFirstFrame) {
  for (const bool repeat : {false, true}) {
    Frames frames(with_earlier(3));
    ASSERT_TRUE(frames.parse(frames.unit(0), 1));
    const auto parse = [&](std::uint32_t f, std::uint32_t distance_minus1,
                           bool is_refused = false) {
      FrameRecipe recipe = frames.unit(f);
      recipe.earlier = {{distance_minus1, repeat}};
      recipe.has_section = !repeat;
      return frames.parse(recipe, repeat || is_refused ? 0 : 1);
    };
    // The bits before are: frame_idx 3 or 5, layer_group_idx 1, unit_frames_minus1 1, flag 1.
    expect_invalid_at(parse(1, 1, true), "R-FRM-08", "earlier_distance_minus1", 6);
    ASSERT_TRUE(parse(1, 0));
    expect_invalid_at(parse(2, 2, true), "R-FRM-08", "earlier_distance_minus1", 6);
    ASSERT_TRUE(parse(2, 1));
    ASSERT_TRUE(parse(3, 0));
    expect_invalid_at(parse(4, 3, true), "R-FRM-08", "earlier_distance_minus1", 8);
    ASSERT_TRUE(parse(4, 2));
    const InterGof gof = frames.units().parser().finish();
    const std::uint32_t earlier[] = {0, 0, 0, 2, 1};
    for (std::uint32_t f = 1; f < 5; ++f) {
      const InterFrame& frame = (*gof.frames)[f];
      EXPECT_EQ(repeat ? frame.repeated : frame.reference, earlier[f]);
      EXPECT_FALSE(repeat ? frame.reference : frame.repeated);
    }
  }
}

// The order is 0, 2, 1, 4, 3, and frames 1 and 3 are in temporal layer 1.
TEST(ParseFrameUnitRanges, EarlierFramesAreNotInAHigherTemporalLayer) {
  InterGofRecipe recipe = with_earlier(2);
  recipe.pattern = FramePatternRecipe::dyadic(1, 1);
  recipe.frame_step_minus1 = {0, 0};
  const auto parse = [&](std::uint32_t distance_minus1) {
    Frames frames(recipe);
    EXPECT_TRUE(frames.parse(frames.unit(0), 1));
    for (const auto& [f, minus1] : {std::pair{2U, 0U}, {1U, 0U}}) {
      FrameRecipe repeat = frames.unit(f);
      repeat.earlier = {{minus1, true}};
      repeat.has_section = false;
      EXPECT_TRUE(frames.parse(repeat, 0));
    }
    FrameRecipe last = frames.unit(4);
    last.earlier = {{distance_minus1, true}};
    last.has_section = false;
    return frames.parse(last, 0);
  };
  EXPECT_TRUE(parse(1));
  // The bits before are: frame_idx 5, layer_group_idx 1, unit_frames_minus1 1, earlier_flag 1.
  expect_invalid_at(parse(0), "R-FRM-08", "earlier_distance_minus1", 8);
}

TEST(ParseFrameUnitRanges, StepsOfFramesAreInTheirRange) {
  InterGofRecipe recipe;
  recipe.num_gof_frames_minus1 = 8;
  recipe.frame_step_delta_flag = true;
  Frames frames(recipe);
  FrameRecipe shared = frames.unit(0, 4);  // the first frame has no difference
  shared.frame_step_delta = {-15, 240, 0};
  ASSERT_TRUE(frames.parse(shared, 4));
  for (const std::int32_t delta : {-16, 241}) {
    Frames others(recipe);
    ASSERT_TRUE(others.parse(others.unit(0), 1));
    FrameRecipe wrong = others.unit(1);
    wrong.frame_step_delta = {delta};
    // The bits before are: frame_idx 3, layer_group_idx 1, unit_frames_minus1 1.
    expect_invalid_at(others.parse(wrong, 0), "R-FRM-10", "frame_step_delta", 5);
  }
  const InterGof gof = frames.units().parser().finish();
  EXPECT_TRUE(gof.step_delta_flag);
  const std::int32_t deltas[] = {0, -15, 240, 0, 0};
  for (std::size_t f = 0; f < 5; ++f) EXPECT_EQ((*gof.frames)[f].step_delta, deltas[f]);
}

TEST(ParseFrameUnitRanges, FramesWithoutResidualsEndWithTheirFlags) {
  Frames frames(with_earlier(1));
  ASSERT_TRUE(frames.parse(frames.unit(0), 1));
  FrameRecipe repeats = frames.unit(1, 3);
  repeats.earlier = {{0, true}, {0, true}, {0, true}};
  repeats.frame_crc = {5};  // bytes that nothing takes
  repeats.has_section = false;
  expect_invalid_at(frames.parse(repeats, 0), "R-BIT-03", "unit_payload", 16);
}

TEST(ParseFrameUnitRanges, HashesTakeAllValues) {
  InterGofRecipe recipe;
  recipe.frame_hash_flag = true;
  Frames frames(recipe);
  FrameRecipe unit = frames.unit(0, 3);
  unit.frame_crc = {0, 0xFFFFFFFF, 0x80000001};
  ASSERT_TRUE(frames.parse(unit, 3));
  const InterGof gof = frames.units().parser().finish();
  for (std::uint32_t f = 0; f < 3; ++f) {
    ASSERT_TRUE((*gof.frames)[f].frame_crc);
    EXPECT_EQ((*gof.frames)[f].frame_crc->crc, unit.frame_crc[f]);
    EXPECT_EQ((*gof.frames)[f].frame_crc->bit_pos, kPayloadBitPos + 8 + 32 * f);
  }
}

// All residuals of a frame could be large.
TEST(ParseFrameUnitRanges, ResidualsStayWithinTheMemoryOfTheCaller) {
  const std::uint64_t gof_bytes = Frames{InterGofRecipe{}}.units().parser().memory_bytes();
  const std::uint64_t frame_bytes = memory_of_frame(9, 27, 0);
  const auto parse = [](std::uint64_t bytes) {
    Frames frames(InterGofRecipe{}, false, bytes);
    return frames.parse(frames.unit(0), 1);
  };
  const auto too_little = parse(gof_bytes + frame_bytes);
  ASSERT_FALSE(too_little);
  EXPECT_EQ(too_little.error().code, Errc::kLimitExceeded);
  EXPECT_STREQ(too_little.error().element, "frame_section");
  EXPECT_EQ(too_little.error().bit_pos, kPayloadBitPos + 8);
  const std::uint64_t needed = too_little.error().needed_bytes;
  EXPECT_GT(needed, gof_bytes + frame_bytes);
  EXPECT_LT(needed, gof_bytes + frame_bytes + 8);  // the section, of zeros
  EXPECT_TRUE(parse(needed));
  EXPECT_FALSE(parse(needed - 1));
}

}  // namespace
}  // namespace rlpc
