#include "common/codec/bits/bit_reader.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_writer.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr Range kAny{0, 0xFFFFFFFE};
constexpr Range kAnySigned{-2147483647, 2147483647};

// Copies exactly `size` bytes to the heap, so that sanitizers detect a read past them.
Bytes prefix_of(const Bytes& bytes, std::size_t size) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

void expect_error(const BitReader& r, Errc code, const std::string& rule,
                  const std::string& element, std::uint64_t bit_pos) {
  ASSERT_TRUE(r.error());
  EXPECT_EQ(r.error()->code, code);
  EXPECT_EQ(r.error()->rule, rule);
  EXPECT_EQ(r.error()->element, element);
  EXPECT_EQ(r.error()->bit_pos, bit_pos);
}

TEST(BitReader, ReadsTheMostSignificantBitFirst) {
  // 1 | 010 | 1100 0011 | 1010
  const Bytes bytes{0b1010'1100, 0b0011'1010};
  BitReader r(bytes);
  EXPECT_TRUE(r.flag("a"));
  EXPECT_EQ(r.u(3, "b"), 2U);
  EXPECT_EQ(r.bit_pos(), 4U);
  EXPECT_EQ(r.u(8, "c"), 0xC3U);
  EXPECT_EQ(r.u(4, "d"), 10U);
  r.expect_end();
  EXPECT_FALSE(r.error());
}

TEST(BitReader, ReadsTheExpGolombCodesOfTheSpecification) {
  // 0 -> 1, 1 -> 010, 2 -> 011, 3 -> 00100, then 0001000 (7) and the stop bits of the byte
  const Bytes bytes{0b1010'0110, 0b0100'0001, 0b0000'0000};
  BitReader r(bytes);
  for (const std::uint32_t expected : {0U, 1U, 2U, 3U, 7U}) {
    EXPECT_EQ(r.ue("value", kAny, "R-X"), expected);
  }
  EXPECT_EQ(r.bit_pos(), 19U);
  BitReader s(bytes);
  for (const std::int32_t expected : {0, 1, -1, 2, 4}) {
    EXPECT_EQ(s.se("value", kAnySigned, "R-X"), expected);
  }
}

TEST(BitReader, ReadsWhatTheWriterWrote) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    BitWriter w;
    std::vector<std::pair<int, std::uint32_t>> written;  // kind (1 to 34, or 0), value
    for (int i = 0; i < 2000; ++i) {
      const int kind = static_cast<int>(random() % 36);
      auto value = static_cast<std::uint32_t>(random() >> (random() % 32));
      if (kind >= 1 && kind <= 32) {
        value &= static_cast<std::uint32_t>((std::uint64_t{1} << kind) - 1);
        w.u(kind, value);
      } else if (kind == 33) {
        value = value == 0xFFFFFFFF ? 0 : value;
        w.ue(value);
      } else if (kind == 34) {
        value = value == 0x80000000 ? 0 : value;
        w.se(static_cast<std::int32_t>(value));
      } else if (kind == 35) {
        w.byte_alignment();
      } else {
        w.flag(value % 2 == 1);
        value %= 2;
      }
      written.emplace_back(kind, value);
    }
    w.byte_alignment();
    const Bytes bytes = w.take();
    BitReader r(bytes);
    for (const auto& [kind, value] : written) {
      if (kind >= 1 && kind <= 32) {
        ASSERT_EQ(r.u(kind, "u"), value);
      } else if (kind == 33) {
        ASSERT_EQ(r.ue("ue", kAny, "R-X"), value);
      } else if (kind == 34) {
        ASSERT_EQ(r.se("se", kAnySigned, "R-X"), static_cast<std::int32_t>(value));
      } else if (kind == 35) {
        r.byte_alignment();
      } else {
        ASSERT_EQ(r.flag("flag"), value == 1);
      }
    }
    r.byte_alignment();
    r.expect_end();
    EXPECT_FALSE(r.error());
  }
}

TEST(BitReader, EveryLengthOfExpGolombCodeRoundTrips) {
  for (int zeros = 0; zeros < 32; ++zeros) {
    const auto first = static_cast<std::uint32_t>((std::uint64_t{1} << zeros) - 1);
    const auto last = static_cast<std::uint32_t>((std::uint64_t{2} << zeros) - 2);
    for (const std::uint32_t value : {first, last}) {
      BitWriter w;
      w.ue(value);
      w.byte_alignment();
      const Bytes bytes = w.take();
      BitReader r(bytes);
      EXPECT_EQ(r.ue("value", kAny, "R-X"), value);
      EXPECT_EQ(r.bit_pos(), static_cast<std::uint64_t>(2 * zeros + 1));
    }
  }
  for (const std::int32_t value : {-2147483647, 2147483647, -1, 1, 0}) {
    BitWriter w;
    w.se(value);
    w.byte_alignment();
    const Bytes bytes = w.take();
    BitReader r(bytes);
    EXPECT_EQ(r.se("value", kAnySigned, "R-X"), value);
  }
}

// The values from 2^32 - 1 have codes with 32 zeros; they are outside the range of every
// element.
TEST(BitReader, CodesOf32ZerosAreReadAndOutOfRange) {
  const Bytes bytes{0, 0, 0, 0, 0x80, 0, 0, 0, 0};
  BitReader r(bytes);
  EXPECT_EQ(r.ue("value", kAny, "R-X-01"), 0U);
  expect_error(r, Errc::kInvalid, "R-X-01", "value", 0);
  BitReader s(bytes);
  EXPECT_EQ(s.se("value", {-5, 5}, "R-X-02"), -5);
  expect_error(s, Errc::kInvalid, "R-X-02", "value", 0);
}

TEST(BitReader, CodesOf33ZerosAreInvalid) {
  const Bytes bytes{0x80, 0, 0, 0, 0x20, 0, 0, 0, 0, 0};
  BitReader r(bytes);
  r.flag("flag");
  EXPECT_EQ(r.ue("value", {3, 9}, "R-X-01"), 3U);
  expect_error(r, Errc::kInvalid, "R-BIT-04", "value", 1);
}

TEST(BitReader, AnAllZeroPayloadEnds) {
  const Bytes bytes(3, 0);
  BitReader r(bytes);
  r.ue("value", kAny, "R-X-01");
  expect_error(r, Errc::kTruncated, "R-BIT-01", "value", 0);
}

TEST(BitReader, EveryProperPrefixFailsAtTheElementThatIsCut) {
  // u(13) 4660 | ue 40 (11 bits) | u(32) | flag | 7 zero bits
  BitWriter w;
  w.u(13, 4660);
  w.ue(40);
  w.u(32, 0x89ABCDEF);
  w.flag(true);
  w.byte_alignment();
  const Bytes bytes = w.take();
  ASSERT_EQ(bytes.size(), 8U);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const Bytes exact = prefix_of(bytes, n);
    BitReader r(exact);
    r.u(13, "first");
    r.ue("second", kAny, "R-X");
    r.u(32, "third");
    r.flag("fourth");
    const std::string element = n < 2 ? "first" : n < 3 ? "second" : n < 7 ? "third" : "fourth";
    const std::uint64_t at = n < 2 ? 0 : n < 3 ? 13 : n < 7 ? 24 : 56;
    ASSERT_TRUE(r.error()) << n;
    EXPECT_EQ(r.error()->code, Errc::kTruncated);
    EXPECT_EQ(r.error()->rule, std::string("R-BIT-01"));
    EXPECT_EQ(r.error()->element, element) << n;
    EXPECT_EQ(r.error()->bit_pos, at) << n;
  }
}

TEST(BitReader, RangesNameRuleElementAndPosition) {
  const Bytes bytes{0x15, 0x20, 0x00};  // u(8) 21, then ue 3 is 00100
  for (const Range range : {Range{0, 20}, Range{22, 40}}) {
    BitReader r(bytes, 800);
    EXPECT_EQ(r.u(8, "size", range, "R-ABC-07"), static_cast<std::uint32_t>(range.min));
    expect_error(r, Errc::kInvalid, "R-ABC-07", "size", 800);
  }
  for (const Range range : {Range{0, 2}, Range{4, 9}}) {
    BitReader r(bytes, 800);
    r.u(8, "size");
    EXPECT_EQ(r.ue("count", range, "R-ABC-08"), static_cast<std::uint32_t>(range.min));
    expect_error(r, Errc::kInvalid, "R-ABC-08", "count", 808);
  }
  for (const Range range : {Range{-9, 1}, Range{3, 9}}) {
    BitReader r(bytes, 16);
    r.u(8, "size");
    EXPECT_EQ(r.se("offset", range, "R-ABC-09"), range.min);
    expect_error(r, Errc::kInvalid, "R-ABC-09", "offset", 24);
  }
  BitReader inside(bytes, 800);
  EXPECT_EQ(inside.u(8, "size", {21, 21}, "R-ABC-07"), 21U);
  EXPECT_EQ(inside.ue("count", {3, 3}, "R-ABC-08"), 3U);
  EXPECT_FALSE(inside.error());
}

TEST(BitReader, AfterAFailureReadsGiveTheLowestLegalValueAndTheFirstErrorStays) {
  const Bytes bytes{0xFF, 0xFF};
  BitReader r(bytes);
  r.u(4, "first", {0, 3}, "R-ONE");
  EXPECT_EQ(r.u(4, "second", {7, 9}, "R-TWO"), 7U);
  EXPECT_EQ(r.ue("third", {5, 6}, "R-THREE"), 5U);
  EXPECT_EQ(r.se("fourth", {-8, 6}, "R-FOUR"), -8);
  EXPECT_FALSE(r.flag("fifth"));
  r.fail(Errc::kUnsupported, "R-FIVE", "sixth", 99);
  r.byte_alignment();
  r.expect_end();
  expect_error(r, Errc::kInvalid, "R-ONE", "first", 0);
}

TEST(BitReader, AlignmentBitsAreZero) {
  for (int bit = 0; bit < 5; ++bit) {
    const Bytes bytes{static_cast<std::uint8_t>(0b1010'0000 | (1 << bit)), 0x77};
    BitReader r(bytes, 40);
    EXPECT_EQ(r.u(3, "value"), 5U);
    r.byte_alignment();
    expect_error(r, Errc::kInvalid, "R-BIT-02", "alignment_zero_bits", 43);
  }
  const Bytes bytes{0b1010'0000, 0x77};
  BitReader r(bytes);
  r.byte_alignment();  // nothing to skip
  EXPECT_EQ(r.bit_pos(), 0U);
  r.u(3, "value");
  r.byte_alignment();
  EXPECT_EQ(r.bit_pos(), 8U);
  ASSERT_EQ(r.remaining_bytes().size(), 1U);
  EXPECT_EQ(r.remaining_bytes()[0], 0x77);
  EXPECT_FALSE(r.error());
}

TEST(BitReader, UnreadBytesAreInvalid) {
  const Bytes bytes{0x12, 0x34};
  BitReader r(bytes, 80);
  r.u(8, "value");
  r.expect_end();
  expect_error(r, Errc::kInvalid, "R-BIT-03", "unit_payload", 88);
}

class ElementLog : public Trace {
 public:
  void begin(const char*, std::uint64_t) override {}
  void element(const char* name, std::int64_t value, std::uint64_t bit_pos) override {
    text += std::to_string(bit_pos) + " " + name + " " + std::to_string(value) + "\n";
  }
  std::string text;
};

TEST(BitReader, TracesEveryElementUpToTheFirstError) {
  BitWriter w;
  w.u(5, 17);
  w.ue(6);
  w.se(-2);
  w.flag(true);
  w.byte_alignment();
  const Bytes bytes = w.take();
  ElementLog log;
  BitReader r(bytes, 1000, &log);
  r.u(5, "a");
  r.ue("b", {0, 6}, "R-X");
  r.se("c", {-1, 6}, "R-X");
  r.flag("d");
  EXPECT_EQ(log.text, "1000 a 17\n1005 b 6\n1010 c -2\n");
}

}  // namespace
}  // namespace rlpc
