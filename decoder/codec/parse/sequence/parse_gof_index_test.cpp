#include "decoder/codec/parse/sequence/parse_gof_index.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "decoder/testing/expected_errors.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Index = Result<GofIndex>;

// num_index_gofs_minus1 2, first_gof_offset 45, then index_gof_frames_minus1 and
// index_gof_bytes: 2 and 100, 0 and 20, 1 and 70000, alignment
const Bytes kLegalIndex{0x60, 0xB9, 0x81, 0x96, 0x15, 0x40, 0x00, 0x11, 0x17, 0x10};

Index index_in(const Bytes& payload, std::uint32_t num_frames) {
  BitReader r(payload);
  SequenceHeader header;
  header.num_frames = num_frames;
  return parse_gof_index(r, header);
}

// num_index_gofs_minus1; index_gof_frames_minus1 and index_gof_bytes of each GOF
Bytes payload_of(std::uint32_t num_index_gofs_minus1,
                 const std::vector<std::pair<std::uint32_t, std::uint32_t>>& gofs) {
  BitWriter w;
  w.ue(num_index_gofs_minus1);
  w.ue(45);
  for (const auto& [frames_minus1, bytes] : gofs) {
    w.ue(frames_minus1);
    w.ue(bytes);
  }
  w.byte_alignment();
  return w.take();
}

TEST(ParseGofIndex, GivesOffsetsAndFirstFrames) {
  const Index index = index_in(kLegalIndex, 6);
  ASSERT_TRUE(index);
  ASSERT_EQ(index->gofs.size(), 3U);
  EXPECT_EQ(index->gofs[0].offset, 45U);
  EXPECT_EQ(index->gofs[0].first_frame, 0U);
  EXPECT_EQ(index->gofs[1].offset, 145U);
  EXPECT_EQ(index->gofs[1].first_frame, 3U);
  EXPECT_EQ(index->gofs[2].offset, 165U);
  EXPECT_EQ(index->gofs[2].first_frame, 4U);
}

TEST(ParseGofIndex, EveryProperPrefixFails) {
  for (std::size_t n = 0; n < kLegalIndex.size(); ++n) {
    const Bytes exact(kLegalIndex.begin(),
                      kLegalIndex.begin() + static_cast<std::ptrdiff_t>(n));
    const Index index = index_in(exact, 6);
    ASSERT_FALSE(index) << n;
    EXPECT_EQ(index.error().code, Errc::kTruncated) << n;
  }
}

TEST(ParseGofIndex, OffsetsBeyond32BitsAddUp) {
  const std::uint32_t max_size = 0xFFFFFFFE;
  const Index index = index_in(payload_of(2, {{0, max_size}, {0, max_size}, {0, max_size}}), 3);
  ASSERT_TRUE(index);
  EXPECT_EQ(index->gofs[2].offset, 45 + 2 * std::uint64_t{max_size});
}

TEST(ParseGofIndex, FramesOfTheGofsAreThoseOfTheSequence) {
  EXPECT_TRUE(index_in(payload_of(1, {{2, 9}, {3, 9}}), 7));
  // One frame fewer than the sequence has, and one more.
  expect_invalid(index_in(payload_of(1, {{2, 9}, {2, 9}}), 7), "R-IDX-01", "index_gof_bytes");
  expect_invalid(index_in(payload_of(1, {{2, 9}, {4, 9}}), 7), "R-IDX-01",
                 "index_gof_frames_minus1");
  // The GOFs before the last one already have all frames.
  expect_invalid(index_in(payload_of(2, {{2, 9}, {3, 9}, {0, 9}}), 7), "R-IDX-01",
                 "index_gof_bytes");
  expect_invalid(index_in(payload_of(0, {{7, 9}}), 7), "R-IDX-01", "index_gof_frames_minus1");
}

TEST(ParseGofIndex, HasAtMostOneGofPerFrame) {
  EXPECT_TRUE(index_in(payload_of(1, {{0, 9}, {0, 9}}), 2));
  expect_invalid(index_in(payload_of(2, {{0, 9}, {0, 9}, {0, 9}}), 2), "R-IDX-01",
                 "num_index_gofs_minus1");
  // Declaring too many GOFs fails before any of them is read.
  expect_invalid(index_in(payload_of(0xFFFFFFFE, {}), 1 << 24), "R-IDX-01",
                 "num_index_gofs_minus1");
}

TEST(ParseGofIndex, AlignmentIsZeroAndEndsThePayload) {
  Bytes wrong = kLegalIndex;
  wrong.back() |= 1;
  expect_invalid(index_in(wrong, 6), "R-BIT-02", "alignment_zero_bits");
  Bytes longer = kLegalIndex;
  longer.push_back(0);
  expect_invalid(index_in(longer, 6), "R-BIT-03", "unit_payload");
}

}  // namespace
}  // namespace rlpc
