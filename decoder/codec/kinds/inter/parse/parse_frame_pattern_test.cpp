#include "decoder/codec/kinds/inter/parse/parse_frame_pattern.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "common/testing/inter_gof_recipe.h"
#include "decoder/testing/inter_gof_units.h"

namespace rlpc {
namespace {

using Entries = std::vector<PatternEntryRecipe>;

// An element after the pattern, which is read only if the pattern takes its own bits.
constexpr std::uint32_t kMark = 0x2A5;

Bytes bytes_of(const FramePatternRecipe& recipe) {
  BitWriter w;
  recipe.write(w);
  w.u(10, kMark);
  w.byte_alignment();
  return w.take();
}

FramePattern parse_legal(const FramePatternRecipe& recipe) {
  const Bytes bytes = bytes_of(recipe);
  BitReader r(bytes, kPayloadBitPos);
  FramePattern pattern = parse_frame_pattern(r);
  EXPECT_EQ(r.u(10, "mark"), kMark);
  EXPECT_FALSE(r.error());
  return pattern;
}

Result<bool> parse_recipe(const FramePatternRecipe& recipe) {
  const Bytes bytes = bytes_of(recipe);
  BitReader r(bytes, kPayloadBitPos);
  parse_frame_pattern(r);
  if (r.error()) return *r.error();
  return true;
}

TEST(ParseFramePattern, WithoutAPeriodHasOneDepthAndNoLayers) {
  for (const std::uint32_t idc : {0U, 1U}) {
    const FramePattern pattern = parse_legal({idc, 1, {}, {}});
    EXPECT_EQ(pattern.kind, idc == 0 ? FramePattern::kPrevious : FramePattern::kFirst);
    EXPECT_EQ(pattern.num_depths(), 1U);
    EXPECT_EQ(pattern.period(), 1U);
    EXPECT_EQ(pattern.temporal_layers, 1U);
  }
}

TEST(ParseFramePattern, OfDyadicPeriodsTakesOneToSix) {
  for (std::uint32_t log2 = 1; log2 <= 6; ++log2) {
    const FramePattern pattern = parse_legal(FramePatternRecipe::dyadic(log2, 0));
    EXPECT_EQ(pattern.kind, FramePattern::kDyadic);
    EXPECT_EQ(pattern.period(), 1U << log2);
    EXPECT_EQ(pattern.num_depths(), log2 + 1);
  }
  expect_invalid_at(parse_recipe(FramePatternRecipe::dyadic(0, 0)), "R-FRM-05",
                    "pattern_period_log2", 2);
  expect_invalid_at(parse_recipe(FramePatternRecipe::dyadic(7, 0)), "R-FRM-05",
                    "pattern_period_log2", 2);
}

TEST(ParseFramePattern, HasFewerHigherLayersThanDepths) {
  for (std::uint32_t log2 = 1; log2 <= 6; ++log2) {
    for (std::uint32_t layers_minus1 = 0; layers_minus1 < 8; ++layers_minus1) {
      const FramePatternRecipe recipe = FramePatternRecipe::dyadic(log2, layers_minus1);
      if (layers_minus1 <= log2) {
        EXPECT_EQ(parse_legal(recipe).temporal_layers, layers_minus1 + 1);
      } else {
        expect_invalid_at(parse_recipe(recipe), "R-FRM-07", "temporal_layers_minus1", 5);
      }
    }
  }
}

// The elements are frame_pattern_idc 11, pattern_period_minus1 00001; offset 00001, flag 0,
// reference 000000, depth 000; offset 00000, flag 1, references 000000 and 000010, depth 001;
// and temporal_layers_minus1 001.
TEST(ParseFramePattern, ReadsTheBitsOfAnExplicitPattern) {
  const Bytes bytes{0b11000010, 0b00010000, 0b00000000, 0b00010000, 0b00000010, 0b00100100};
  BitReader r(bytes);
  const FramePattern pattern = parse_frame_pattern(r);
  ASSERT_FALSE(r.error());
  EXPECT_EQ(r.bit_pos(), 46U);
  EXPECT_EQ(pattern.kind, FramePattern::kExplicit);
  EXPECT_EQ(pattern.entries, (std::vector<PatternEntry>{{2, {0, 0}, 0}, {1, {0, 2}, 1}}));
  EXPECT_EQ(pattern.temporal_layers, 2U);
}

TEST(ParseFramePattern, OfOneExplicitEntryHasNoLayers) {
  const FramePattern pattern = parse_legal(FramePatternRecipe::from_entries({{0, {0}, 0}}));
  EXPECT_EQ(pattern.period(), 1U);
  EXPECT_EQ(pattern.temporal_layers, 1U);
}

// Each of 32 frames is predicted from the one before.
TEST(ParseFramePattern, TakesTheLongestExplicitPeriod) {
  Entries entries;
  for (std::uint32_t k = 0; k < 32; ++k) entries.push_back({k, {k}, 0});
  const FramePattern pattern = parse_legal(FramePatternRecipe::from_entries(entries));
  ASSERT_EQ(pattern.entries.size(), 32U);
  EXPECT_EQ(pattern.entries[31], (PatternEntry{32, {31, 31}, 0}));
}

TEST(ParseFramePattern, TakesAllDepths) {
  for (std::uint32_t depth = 0; depth < 8; ++depth) {
    Entries entries{{1, {0}, 0}, {0, {0, 2}, depth}};
    const std::optional<std::uint32_t> layers =
        depth > 0 ? std::optional<std::uint32_t>(depth) : std::nullopt;
    const FramePattern pattern = parse_legal(FramePatternRecipe::from_entries(entries, layers));
    EXPECT_EQ(pattern.num_depths(), depth + 1);
    EXPECT_EQ(pattern.temporal_layers, depth + 1);
    if (depth == 0 || depth == 7) continue;
    expect_invalid_at(parse_recipe(FramePatternRecipe::from_entries(entries, depth + 1)),
                      "R-FRM-07", "temporal_layers_minus1", 43);
  }
}

struct Broken {
  const char* element;
  std::uint64_t bit_pos;
  Entries entries;
};

// The first entry begins at bit 7, and one with a single reference takes 15 bits.
TEST(ParseFramePattern, EntriesFollowTheirReferences) {
  const std::vector<Broken> list{
      // An offset beyond the period.
      {"pattern_offset_minus1", 7, {{2, {0}, 0}, {0, {0}, 0}}},
      {"pattern_offset_minus1", 22, {{0, {0}, 0}, {31, {0}, 0}}},
      // An offset that has an entry.
      {"pattern_offset_minus1", 22, {{0, {0}, 0}, {0, {0}, 0}}},
      {"pattern_offset_minus1", 37, {{2, {0}, 0}, {0, {0}, 0}, {2, {0}, 0}}},
      // A reference beyond the period, and ones that have no entry yet, or are the frame.
      {"pattern_reference", 13, {{1, {3}, 0}, {0, {0}, 0}}},
      {"pattern_reference", 13, {{1, {63}, 0}, {0, {0}, 0}}},
      {"pattern_reference", 13, {{1, {1}, 0}, {0, {0}, 0}}},
      {"pattern_reference", 13, {{1, {2}, 0}, {0, {0}, 0}}},
      {"pattern_reference", 28, {{0, {0}, 0}, {1, {3}, 0}}},
      {"pattern_reference", 28, {{0, {0}, 0}, {1, {2}, 0}}},
      {"pattern_reference", 34, {{2, {0}, 0}, {0, {0, 2}, 0}, {1, {0}, 0}}},
      {"pattern_reference", 34, {{2, {0}, 0}, {0, {0, 4}, 0}, {1, {0}, 0}}},
      // Two references on one side, the same twice, or in the wrong order.
      {"pattern_reference", 34, {{0, {0}, 0}, {2, {0, 1}, 0}, {1, {0}, 0}}},
      {"pattern_reference", 34, {{1, {0}, 0}, {0, {0, 0}, 0}}},
      {"pattern_reference", 34, {{1, {0}, 0}, {0, {2, 2}, 0}}},
      {"pattern_reference", 34, {{1, {0}, 0}, {0, {2, 0}, 0}}},
      // A depth less than that of a reference, the first or the second.
      {"pattern_depth", 34, {{0, {0}, 2}, {1, {1}, 1}}},
      {"pattern_depth", 61, {{2, {0}, 0}, {0, {0, 3}, 3}, {1, {1, 3}, 2}}},
      {"pattern_depth", 40, {{1, {0}, 4}, {0, {0, 2}, 3}, {2, {0}, 0}}},
      // The depth at the last offset.
      {"pattern_depth", 34, {{0, {0}, 0}, {1, {0}, 1}}},
      {"pattern_depth", 34, {{1, {0}, 1}, {0, {0}, 1}}},
  };
  for (std::size_t i = 0; i < list.size(); ++i) {
    SCOPED_TRACE(i);
    expect_invalid_at(parse_recipe(FramePatternRecipe::from_entries(list[i].entries, 0)),
                      "R-FRM-06", list[i].element, list[i].bit_pos);
  }
}

TEST(ParseFramePattern, EveryProperPrefixIsTruncated) {
  struct Whole {
    FramePatternRecipe recipe;
    std::size_t num_bits;
  };
  const std::vector<Whole> list{
      {FramePatternRecipe::dyadic(3, 1), 8},
      {FramePatternRecipe::from_entries({{1, {0}, 0}, {0, {0, 2}, 1}}, 1), 46},
      {FramePatternRecipe::from_entries({{2, {0}, 0}, {0, {3}, 1}, {1, {1, 3}, 7}}, 7), 61}};
  for (const auto& [recipe, num_bits] : list) {
    const Bytes whole = bytes_of(recipe);
    for (std::size_t n = 0; 8 * n < num_bits; ++n) {
      const Bytes exact(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
      BitReader r(exact, kPayloadBitPos);
      parse_frame_pattern(r);
      ASSERT_TRUE(r.error()) << n;
      EXPECT_EQ(r.error()->code, Errc::kTruncated) << n;
      EXPECT_STREQ(r.error()->rule, "R-BIT-01");
      EXPECT_LE(r.error()->bit_pos, kPayloadBitPos + 8 * n);
      EXPECT_GT(r.error()->bit_pos + 6, kPayloadBitPos + 8 * n);
    }
  }
}

// Parses random bytes: reading must end, and what it returns must be legal.
TEST(ParseFramePattern, EndsOnAnyBytes) {
  std::uint32_t seed = 1;
  int legal = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes(12);
    for (std::uint8_t& byte : bytes) {
      seed = seed * 1664525 + 1013904223;
      byte = static_cast<std::uint8_t>(seed >> 24);
    }
    BitReader r(bytes);
    const FramePattern pattern = parse_frame_pattern(r);
    if (r.error()) {
      EXPECT_TRUE(r.error()->code == Errc::kTruncated || r.error()->code == Errc::kInvalid);
      continue;
    }
    ++legal;
    EXPECT_LE(pattern.temporal_layers, pattern.num_depths());
    EXPECT_LE(pattern.num_depths(), kMaxPatternDepths);
  }
  EXPECT_GT(legal, 1000);
}

}  // namespace
}  // namespace rlpc
