#include "decoder/codec/parse/parse_gof_hash.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "decoder/testing/expected_errors.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

// per_frame_flag 1, alignment, position_crc 0x01234567 and 0x89ABCDEF
const Bytes kPerFrame{0x80, 0x01, 0x23, 0x45, 0x67, 0x89, 0xAB, 0xCD, 0xEF};
// per_frame_flag 0, alignment, position_crc 0x89ABCDEF
const Bytes kWhole{0x00, 0x89, 0xAB, 0xCD, 0xEF};

Result<GofHash> hash_in(const Bytes& payload, std::uint32_t num_frames) {
  BitReader r(payload, 16);
  return parse_gof_hash(r, num_frames);
}

TEST(ParseGofHash, HasOneCrcPerFrameOrOneForTheGof) {
  const auto per_frame = hash_in(kPerFrame, 2);
  ASSERT_TRUE(per_frame);
  EXPECT_TRUE(per_frame->per_frame_flag);
  EXPECT_EQ(per_frame->position_crc, (std::vector<std::uint32_t>{0x01234567, 0x89ABCDEF}));
  const auto whole = hash_in(kWhole, 2);
  ASSERT_TRUE(whole);
  EXPECT_FALSE(whole->per_frame_flag);
  EXPECT_EQ(whole->position_crc, std::vector<std::uint32_t>{0x89ABCDEF});
}

TEST(ParseGofHash, EveryProperPrefixFails) {
  for (const Bytes& legal : {kPerFrame, kWhole}) {
    expect_error_at(hash_in({}, 2), Errc::kTruncated, "R-BIT-01", "per_frame_flag", 16);
    for (std::size_t n = 1; n < legal.size(); ++n) {
      const Bytes exact(legal.begin(), legal.begin() + static_cast<std::ptrdiff_t>(n));
      expect_error_at(hash_in(exact, 2), Errc::kInvalid, "R-HSH-01", "position_crc", 24);
    }
  }
}

TEST(ParseGofHash, AnotherNumberOfFramesIsInvalid) {
  expect_error_at(hash_in(kPerFrame, 1), Errc::kInvalid, "R-HSH-01", "position_crc", 24);
  expect_error_at(hash_in(kPerFrame, 3), Errc::kInvalid, "R-HSH-01", "position_crc", 24);
  Bytes longer = kWhole;
  longer.push_back(0);
  expect_error_at(hash_in(longer, 2), Errc::kInvalid, "R-HSH-01", "position_crc", 24);
}

TEST(ParseGofHash, AlignmentBitsAreZero) {
  for (int bit = 0; bit < 7; ++bit) {
    Bytes wrong = kWhole;
    wrong[0] = static_cast<std::uint8_t>(1 << bit);
    expect_error_at(hash_in(wrong, 2), Errc::kInvalid, "R-BIT-02", "alignment_zero_bits", 17);
  }
}

}  // namespace
}  // namespace rlpc
