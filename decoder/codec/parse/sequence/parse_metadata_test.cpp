#include "decoder/codec/parse/sequence/parse_metadata.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "decoder/testing/expected_errors.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

// metadata_size 25, then {"author": "A. N. Other"}, deflated
const Bytes kLegalMetadata{0x00, 0x00, 0x00, 0x19, 0x78, 0xDA, 0xAB, 0x56, 0x4A, 0x2C,
                           0x2D, 0xC9, 0xC8, 0x2F, 0x52, 0xB2, 0x52, 0x50, 0x72, 0xD4,
                           0x53, 0xF0, 0xD3, 0x53, 0xF0, 0x2F, 0xC9, 0x48, 0x2D, 0x52,
                           0xAA, 0x05, 0x00, 0x64, 0xA7, 0x07, 0x9B};
// metadata_size 0, then nothing, deflated
const Bytes kEmptyMetadata{0x00, 0x00, 0x00, 0x00, 0x78, 0xDA,
                           0x03, 0x00, 0x00, 0x00, 0x00, 0x01};

Result<std::string> metadata_in(const Bytes& payload) {
  BitReader r(payload, 8);
  return parse_metadata(r, {UINT64_MAX, 0});
}

TEST(ParseMetadata, InflatesTheText) {
  const auto json = metadata_in(kLegalMetadata);
  ASSERT_TRUE(json);
  EXPECT_EQ(*json, "{\"author\": \"A. N. Other\"}");
}

TEST(ParseMetadata, TheTextMayBeEmpty) {
  const auto json = metadata_in(kEmptyMetadata);
  ASSERT_TRUE(json);
  EXPECT_EQ(*json, "");
}

TEST(ParseMetadata, EveryProperPrefixFails) {
  for (const Bytes& legal : {kLegalMetadata, kEmptyMetadata}) {
    for (std::size_t n = 0; n < legal.size(); ++n) {
      const Bytes exact(legal.begin(), legal.begin() + static_cast<std::ptrdiff_t>(n));
      if (n < 4) {
        expect_error(metadata_in(exact), Errc::kTruncated, "R-BIT-01", "metadata_size");
      } else {
        expect_error(metadata_in(exact), Errc::kInvalid, "R-MET-02", "metadata_json");
      }
    }
  }
}

// Flips all bits except the last ones of the deflated blocks, which are padding.
TEST(ParseMetadata, EveryFlippedBitFails) {
  constexpr std::size_t kLastBlockByte = 32;
  for (std::size_t bit = 0; bit < 8 * kLegalMetadata.size(); ++bit) {
    if (bit / 8 == kLastBlockByte) continue;
    Bytes wrong = kLegalMetadata;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_FALSE(metadata_in(wrong)) << bit;
  }
}

TEST(ParseMetadata, TheSizeIsThatOfTheText) {
  for (const int size : {0, 24, 26, 255}) {
    Bytes wrong = kLegalMetadata;
    wrong[3] = static_cast<std::uint8_t>(size);
    expect_error(metadata_in(wrong), Errc::kInvalid, "R-MET-02", "metadata_json");
  }
}

TEST(ParseMetadata, BytesLeftOverAreInvalid) {
  Bytes longer = kLegalMetadata;
  longer.push_back(0);
  expect_error(metadata_in(longer), Errc::kInvalid, "R-MET-02", "metadata_json");
}

TEST(ParseMetadata, TheSizeIsBounded) {
  Bytes large = kLegalMetadata;
  large[1] = 0x10;  // 2^20 and more
  expect_error(metadata_in(large), Errc::kInvalid, "R-MET-01", "metadata_size");
  large[3] = 0x00;  // 2^20, more than the size of this text
  expect_error(metadata_in(large), Errc::kInvalid, "R-MET-02", "metadata_json");
  large[0] = 0xFF;
  const auto json = metadata_in(large);
  ASSERT_FALSE(json);
  EXPECT_EQ(json.error().rule, std::string("R-MET-01"));
  EXPECT_EQ(json.error().bit_pos, 8U);
}

}  // namespace
}  // namespace rlpc
