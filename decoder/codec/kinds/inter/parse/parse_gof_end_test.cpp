// 7.14.2: where a GOF of an open-ended stream can end, and frames that are taken before its
// end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/testing/inter_gof_recipe.h"
#include "decoder/testing/inter_gof_units.h"

namespace rlpc {
namespace {

// A GOF of an open-ended stream, of whose frames the first in coding order are coded.
struct OpenGof {
  InterGofUnits units;

  OpenGof(const FramePatternRecipe& pattern, std::uint32_t num_depths, std::uint32_t num_frames,
          std::uint32_t num_coded)
      : units(open_header(), kSquares) {
    InterGofRecipe gof;
    gof.num_gof_frames_minus1 = num_frames - 1;
    gof.pattern = pattern;
    gof.frame_step_minus1.assign(num_depths, 0);
    EXPECT_TRUE(units.gof(gof.payload()));
    InterContexts contexts(units.mesh(), 1, num_depths);
    for (std::uint32_t place = 0; place < num_coded; ++place) {
      const FramePlace& at = units.parser().order()[place];
      FrameRecipe recipe(at.frame);
      recipe.gof_end_flag = false;
      recipe.unit_frames_minus1 = 0;
      contexts.start_group(place, at.depth, 0);
      recipe.zeros(contexts, units.mesh().vertices_of_layers(0, 3));
      EXPECT_TRUE(units.frame(recipe.payload()));
    }
  }
  static SequenceHeader open_header() {
    SequenceHeader header = high_header(9, 40);
    header.open_end_flag = true;
    return header;
  }
  Result<bool> end_before(std::uint32_t frame_idx) {
    FrameRecipe recipe(frame_idx);
    recipe.gof_end_flag = true;
    return units.frame(recipe.payload());
  }
};

void expect_no_end(const Result<bool>& parsed) {
  expect_invalid(parsed, "R-FRM-04", "frame_unit");
  if (parsed) return;
  EXPECT_EQ(parsed.error().bit_pos, kUnitBitPos);
}

TEST(ParseGofEnd, AGofEndsAfterTheFramesThatItHas) {
  for (std::uint32_t end = 0; end < 8; ++end) {
    OpenGof gof({}, 1, 8, 4);
    const auto ok = gof.end_before(end);
    if (end < 4) {
      expect_no_end(ok);
      continue;
    }
    ASSERT_TRUE(ok) << end;
    EXPECT_TRUE(gof.units.parser().last_unit()->is_gof_end);
    EXPECT_EQ(gof.units.parser().order().num_frames(), end);
    const InterGof parsed = gof.units.parser().finish();
    EXPECT_EQ(parsed.num_frames, end);
    EXPECT_EQ(parsed.frames->size(), end);
  }
  OpenGof gof({}, 1, 8, 4);
  expect_invalid_at(gof.end_before(8), "R-FRM-02", "frame_idx", 0);
}

TEST(ParseGofEnd, AnEndThatIsRefusedChangesNothing) {
  OpenGof gof({}, 1, 8, 4);
  FrameRecipe recipe(5);
  recipe.gof_end_flag = true;
  Bytes payload = recipe.payload();
  payload.push_back(0);  // after the end
  expect_invalid(gof.units.frame(payload), "R-BIT-03", "unit_payload");
  EXPECT_EQ(gof.units.parser().order().num_frames(), 8U);
  const InterGof parsed = gof.units.parser().finish();
  EXPECT_EQ(parsed.num_frames, 8U);
  EXPECT_EQ(parsed.frames->size(), 8U);
}

TEST(ParseGofEnd, AGofDoesNotEndBeforeItsFirstFrame) {
  OpenGof gof({}, 1, 8, 0);
  expect_no_end(gof.end_before(0));
  EXPECT_TRUE(gof.end_before(1));
}

// The order is 0, 4, 2, 1, 3, 8, 6, 5, 7. A period that is cut off has an order of its own.
TEST(ParseGofEnd, AGofEndsWhereItsFramesKeepTheirPlaces) {
  struct Case {
    std::uint32_t num_coded;
    std::vector<std::uint32_t> ends;
  };
  const std::vector<Case> cases{
      {1, {1, 2, 3, 4, 5, 6, 7, 8}}, {2, {5, 6, 7, 8}}, {5, {5, 6, 7, 8}}, {6, {}}, {9, {}}};
  for (const auto& [num_coded, ends] : cases) {
    for (std::uint32_t end = 0; end < 9; ++end) {
      OpenGof gof(FramePatternRecipe::dyadic(2, 1), 3, 9, num_coded);
      const auto ok = gof.end_before(end);
      if (std::find(ends.begin(), ends.end(), end) != ends.end()) {
        EXPECT_TRUE(ok) << num_coded << ' ' << end;
      } else {
        expect_no_end(ok);
      }
    }
  }
}

// Each frame is predicted from the last one of the period before; where a period is cut off,
// from the one before it, at depth 0. The order is the same.
TEST(ParseGofEnd, AGofEndsWhereItsFramesKeepTheirReferencesAndDepths) {
  struct Case {
    std::uint32_t num_coded;
    std::vector<std::uint32_t> ends;
  };
  const auto check = [](const FramePatternRecipe& pattern, std::uint32_t num_depths,
                        const std::vector<Case>& cases) {
    for (const auto& [num_coded, ends] : cases) {
      for (std::uint32_t end = num_coded; end < 10; ++end) {
        OpenGof gof(pattern, num_depths, 10, num_coded);
        const auto ok = gof.end_before(end);
        if (std::find(ends.begin(), ends.end(), end) != ends.end()) {
          EXPECT_TRUE(ok) << num_coded << ' ' << end;
        } else {
          expect_no_end(ok);
        }
      }
    }
  };
  check(FramePatternRecipe::from_entries({{0, {0}, 0}, {1, {0}, 0}, {2, {0}, 0}}), 1,
        {{4, {4, 5, 6, 7, 8, 9}}, {5, {5, 6, 7, 8, 9}}, {6, {7, 8, 9}}, {8, {8, 9}}, {9, {}}});
  check(FramePatternRecipe::from_entries({{0, {0}, 1}, {1, {0}, 0}, {2, {0}, 0}}, 0), 2,
        {{4, {4, 5, 6, 7, 8, 9}}, {5, {7, 8, 9}}, {7, {7, 8, 9}}, {8, {}}});
}

TEST(ParseGofEnd, TheEndOfAGofHasNothingElse) {
  const auto parse = [](const Bytes& payload) {
    OpenGof gof({}, 1, 8, 4);
    return gof.units.frame(payload);
  };
  // frame_idx 5 is 00110, gof_end_flag 1
  EXPECT_TRUE(parse({0b00110'1'00}));
  expect_invalid_at(parse({0b00110'1'01}), "R-BIT-02", "alignment_zero_bits", 6);
  expect_invalid_at(parse({0b00110'1'00, 0}), "R-BIT-03", "unit_payload", 8);
  const auto empty = parse({});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, Errc::kTruncated);
  EXPECT_STREQ(empty.error().rule, "R-BIT-01");
}

// Taking a frame frees its memory and keeps what later units need of it.
TEST(ParseGofEnd, FramesCanBeTakenWhenTheyAreComplete) {
  OpenGof gof({}, 1, 8, 3);
  InterGofParser& parser = gof.units.parser();
  const std::uint64_t before = parser.memory_bytes();
  const InterFrame taken = parser.take_frame(1);
  EXPECT_EQ(taken.layer_groups, 1U);
  EXPECT_EQ(taken.residual.size(), 27U);
  EXPECT_EQ(before - parser.memory_bytes(), 5U * 9);
  EXPECT_EQ(parser.complete_places(), 3U);
  EXPECT_EQ((*parser.finish().frames)[1].layer_groups, 1U);
}

}  // namespace
}  // namespace rlpc
