#include "decoder/codec/parse/sequence/parse_sequence_header.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "decoder/testing/expected_errors.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

// profile_idc 0, level_idc 1, num_vertices_minus1 4, num_triangles 3, num_frames_minus1 4,
// frame_rate_numerator_minus1 29999, frame_rate_denominator_minus1 1000, grid_log2_step -9,
// grid_origin 5, -6 and 70, position_bits 12, alignment
const Bytes kLegalHeader{0x00, 0x01, 0x29, 0x0A, 0x00, 0x07, 0x53, 0x00,
                         0x07, 0xD2, 0x13, 0x14, 0x34, 0x04, 0x63, 0x00};

Result<SequenceHeader> header_in(const Bytes& payload, std::uint64_t first_bit = 0) {
  BitReader r(payload, first_bit);
  return parse_sequence_header(r, 0);
}

// Elements in the order of the syntax.
struct Elements {
  std::uint32_t profile_idc = 0;
  std::uint32_t level_idc = 1;
  std::uint32_t num_vertices_minus1 = 0;
  std::uint32_t num_triangles = 0;
  std::uint32_t num_frames_minus1 = 0;
  std::uint32_t frame_rate_numerator_minus1 = 29;
  std::uint32_t frame_rate_denominator_minus1 = 0;
  std::int32_t grid_log2_step = 0;
  std::int32_t grid_origin[3] = {0, 0, 0};
  std::uint32_t position_bits = 20;

  Bytes payload() const {
    BitWriter w;
    w.u(8, profile_idc);
    w.u(8, level_idc);
    w.ue(num_vertices_minus1);
    w.ue(num_triangles);
    w.ue(num_frames_minus1);
    w.ue(frame_rate_numerator_minus1);
    w.ue(frame_rate_denominator_minus1);
    w.se(grid_log2_step);
    for (const std::int32_t origin : grid_origin) w.se(origin);
    w.u(5, position_bits);
    w.byte_alignment();
    return w.take();
  }
};

TEST(ParseSequenceHeader, GivesTheElements) {
  const auto h = header_in(kLegalHeader);
  ASSERT_TRUE(h);
  EXPECT_EQ(h->profile_idc, 0U);
  EXPECT_EQ(h->level_idc, 1U);
  EXPECT_EQ(h->num_vertices, 5U);
  EXPECT_EQ(h->num_triangles, 3U);
  EXPECT_EQ(h->num_frames, 5U);
  EXPECT_EQ(h->frame_rate, (FrameRate{30000, 1001}));
  EXPECT_EQ(h->grid, (Grid{-9, {5, -6, 70}}));
  EXPECT_EQ(h->position_bits, 12);
}

TEST(ParseSequenceHeader, EveryProperPrefixFails) {
  for (std::size_t n = 0; n < kLegalHeader.size(); ++n) {
    const Bytes exact(kLegalHeader.begin(),
                      kLegalHeader.begin() + static_cast<std::ptrdiff_t>(n));
    const auto h = header_in(exact);
    ASSERT_FALSE(h) << n;
    EXPECT_EQ(h.error().code, Errc::kTruncated) << n;
    EXPECT_EQ(h.error().rule, std::string("R-BIT-01")) << n;
  }
}

TEST(ParseSequenceHeader, BytesLeftOverAreInvalid) {
  Bytes longer = kLegalHeader;
  longer.push_back(0);
  expect_error(header_in(longer), Errc::kInvalid, "R-BIT-03", "unit_payload");
}

TEST(ParseSequenceHeader, AlignmentBitsAreZero) {
  Bytes wrong = kLegalHeader;
  wrong.back() |= 1;
  expect_error(header_in(wrong), Errc::kInvalid, "R-BIT-02", "alignment_zero_bits");
}

TEST(ParseSequenceHeader, ErrorsCountFromTheStartOfTheStream) {
  Bytes wrong = kLegalHeader;
  wrong[1] = 0;  // level_idc
  const auto h = header_in(wrong, 120);
  ASSERT_FALSE(h);
  EXPECT_EQ(h.error().bit_pos, 128U);
}

TEST(ParseSequenceHeader, OtherProfilesAndLevelsAreUnsupportedNotInvalid) {
  for (const std::uint32_t profile_idc : {1U, 255U}) {
    Elements e;
    e.profile_idc = profile_idc;
    expect_error(header_in(e.payload()), Errc::kUnsupported, "R-HDR-01", "profile_idc");
  }
  const Bytes baseline = Elements{}.payload();
  BitReader r(baseline);
  const auto later = parse_sequence_header(r, 1);
  ASSERT_FALSE(later);
  EXPECT_EQ(later.error().code, Errc::kUnsupported);
  EXPECT_STREQ(later.error().rule, "R-STR-03");
  EXPECT_EQ(later.error().bit_pos, 72U);
  for (const std::uint32_t level_idc : {0U, kMaxLevelIdc + 1, 255U}) {
    Elements e;
    e.level_idc = level_idc;
    expect_error(header_in(e.payload()), Errc::kUnsupported, "R-HDR-02", "level_idc");
  }
}

TEST(ParseSequenceHeader, LevelsBoundVerticesAndTriangles) {
  for (std::uint32_t level_idc = 1; level_idc <= kMaxLevelIdc; ++level_idc) {
    const Level& level = kLevels[level_idc - 1];
    Elements e;
    e.level_idc = level_idc;
    e.num_vertices_minus1 = level.max_vertices - 1;
    e.num_triangles = level.max_triangles;
    const auto largest = header_in(e.payload());
    ASSERT_TRUE(largest);
    EXPECT_EQ(largest->num_vertices, level.max_vertices);
    EXPECT_EQ(largest->num_triangles, level.max_triangles);
    ++e.num_triangles;
    expect_error(header_in(e.payload()), Errc::kInvalid, "R-LVL-02", "num_triangles");
    ++e.num_vertices_minus1;
    expect_error(header_in(e.payload()), Errc::kInvalid, "R-LVL-01", "num_vertices_minus1");
  }
}

TEST(ParseSequenceHeader, EveryElementIsTakenUpToItsBoundsAndNotBeyond) {
  struct Case {
    std::function<void(Elements&, bool beyond)> set;
    const char* rule;
    const char* element;
  };
  const std::vector<Case> cases{
      {[](Elements& e, bool beyond) { e.num_frames_minus1 = (1U << 24) - (beyond ? 0 : 1); },
       "R-LVL-03", "num_frames_minus1"},
      {[](Elements& e, bool beyond) { e.grid_log2_step = 120 + beyond; }, "R-HDR-04",
       "grid_log2_step"},
      {[](Elements& e, bool beyond) { e.grid_log2_step = -150 - beyond; }, "R-HDR-04",
       "grid_log2_step"},
      {[](Elements& e, bool beyond) { e.grid_origin[0] = (1 << 26) + beyond; }, "R-HDR-05",
       "grid_origin"},
      {[](Elements& e, bool beyond) { e.grid_origin[2] = -(1 << 26) - beyond; }, "R-HDR-05",
       "grid_origin"},
      {[](Elements& e, bool beyond) { e.position_bits = beyond ? 1 : 2; }, "R-HDR-06",
       "position_bits"},
      {[](Elements& e, bool beyond) { e.position_bits = beyond ? 25 : 24; }, "R-HDR-06",
       "position_bits"},
  };
  for (const Case& k : cases) {
    Elements e;
    k.set(e, false);
    EXPECT_TRUE(header_in(e.payload())) << k.element;
    k.set(e, true);
    expect_error(header_in(e.payload()), Errc::kInvalid, k.rule, k.element);
  }
}

TEST(ParseSequenceHeader, FrameRatesTakeAll32BitNumbersButZero) {
  Elements e;
  e.frame_rate_numerator_minus1 = 0xFFFFFFFE;
  e.frame_rate_denominator_minus1 = 0xFFFFFFFE;
  const auto h = header_in(e.payload());
  ASSERT_TRUE(h);
  EXPECT_EQ(h->frame_rate, (FrameRate{0xFFFFFFFF, 0xFFFFFFFF}));

  // A numerator of 2^32 has a code of 32 zeros, a one and 32 zeros.
  BitWriter w;
  w.u(16, 1);
  w.ue(0);
  w.ue(0);
  w.ue(0);
  w.u(32, 0);
  w.u(1, 1);
  w.u(32, 0);
  w.byte_alignment();
  expect_error(header_in(w.take()), Errc::kInvalid, "R-HDR-03", "frame_rate_numerator_minus1");
}

}  // namespace
}  // namespace rlpc
