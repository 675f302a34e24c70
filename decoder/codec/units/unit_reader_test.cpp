#include "decoder/codec/units/unit_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/syntax/write_units.h"
#include "decoder/testing/expected_errors.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

// signature, version_major 1, version_minor 0
const Bytes kHeader{0x89, 0x52, 0x4C, 0x50, 0x43, 0x0D, 0x0A, 0x1A, 0x01, 0x00};
// ancillary_flag 0, unit_type 5, unit_size 4, payload 00 00 00 07, unit_crc
const Bytes kUnit{0x05, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00, 0x07, 0xC7, 0x7A, 0x62, 0x82};
// ancillary_flag 1, unit_type 2, unit_size 0, unit_crc
const Bytes kEmptyUnit{0x82, 0x00, 0x00, 0x00, 0x00, 0x0D, 0x04, 0x14, 0xEF};

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

UnitReader reader_of(Bytes bytes, Trace* trace = nullptr) {
  return UnitReader(memory_source(std::move(bytes)), trace);
}

TEST(StreamHeader, OfThisVersionIsTaken) { EXPECT_TRUE(reader_of(kHeader).stream_header()); }

TEST(StreamHeader, EveryProperPrefixIsTruncated) {
  for (std::size_t n = 0; n < kHeader.size(); ++n) {
    const Bytes prefix(kHeader.begin(), kHeader.begin() + static_cast<std::ptrdiff_t>(n));
    const auto header = reader_of(prefix).stream_header();
    ASSERT_FALSE(header) << n;
    EXPECT_EQ(header.error().code, Errc::kTruncated) << n;
    EXPECT_EQ(header.error().rule, std::string("R-BIT-01")) << n;
  }
}

TEST(StreamHeader, EveryByteOfTheSignatureCounts) {
  for (std::size_t i = 0; i < 8; ++i) {
    Bytes wrong = kHeader;
    wrong[i] ^= 0x20;
    expect_error_at(reader_of(wrong).stream_header(), Errc::kInvalid, "R-STR-01", "signature",
                    0);
    // If the file is also too short, "no RLPC stream" is the better message.
    wrong.resize(i + 1);
    expect_error_at(reader_of(wrong).stream_header(), Errc::kInvalid, "R-STR-01", "signature",
                    0);
  }
}

TEST(StreamHeader, OtherVersionsAreUnsupported) {
  Bytes other = kHeader;
  other[9] = kVersionMinor + 1;
  expect_error_at(reader_of(other).stream_header(), Errc::kUnsupported, "R-STR-03",
                  "version_minor", 72);
  for (const int major : {0, 2, 255}) {
    other[8] = static_cast<std::uint8_t>(major);
    expect_error_at(reader_of(other).stream_header(), Errc::kUnsupported, "R-STR-02",
                    "version_major", 64);
  }
}

TEST(UnitReader, FindsUnitsAndTheirPayloads) {
  UnitReader reader = reader_of(joined({kHeader, kUnit, kEmptyUnit}));
  const auto first = reader.header_at(10);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->type(), UnitType::kEndOfSequence);
  EXPECT_FALSE(first->ancillary());
  EXPECT_EQ(first->size, 4U);
  EXPECT_EQ(first->offset, 10U);
  EXPECT_EQ(first->payload_offset(), 15U);
  EXPECT_EQ(first->end(), 23U);
  const auto payload = reader.payload(*first);
  ASSERT_TRUE(payload);
  EXPECT_EQ(*payload, (Bytes{0, 0, 0, 7}));
  EXPECT_EQ(reader.bits(*first, *payload).bit_pos(), 120U);

  const auto second = reader.header_at(first->end());
  ASSERT_TRUE(second);
  EXPECT_EQ(second->type(), UnitType::kGofHash);
  EXPECT_TRUE(second->ancillary());
  EXPECT_EQ(second->size, 0U);
  EXPECT_EQ(second->end(), reader.size());
  const auto nothing = reader.payload(*second);
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(nothing->empty());
}

TEST(UnitReader, EveryProperPrefixOfAUnitIsTruncated) {
  for (std::size_t n = 0; n < kUnit.size(); ++n) {
    Bytes bytes = joined({kHeader, kUnit});
    bytes.resize(kHeader.size() + n);
    const auto header = reader_of(bytes).header_at(10);
    if (n < kUnitHeaderBytes) {
      expect_error_at(header, Errc::kTruncated, "R-UNT-01", "unit_type", 80);
    } else {
      expect_error_at(header, Errc::kTruncated, "R-UNT-02", "unit_size", 88);
    }
  }
}

TEST(UnitReader, TheLargestSizeDoesNotWrapAround) {
  Bytes bytes = joined({kHeader, kUnit});
  std::fill(bytes.begin() + 11, bytes.begin() + 15, std::uint8_t{0xFF});
  expect_error_at(reader_of(bytes).header_at(10), Errc::kTruncated, "R-UNT-02", "unit_size",
                  88);
}

TEST(UnitReader, LevelLimitOfCriticalUnitsIsCheckedBeforeTheirEnd) {
  Bytes bytes = joined({kHeader, kUnit});  // 4 bytes of payload, a critical unit
  UnitReader reader = reader_of(bytes);
  reader.set_max_unit_bytes(4);
  EXPECT_TRUE(reader.header_at(10));
  reader.set_max_unit_bytes(3);
  expect_error_at(reader.header_at(10), Errc::kInvalid, "R-LVL-07", "unit_size", 88);
  bytes.resize(kHeader.size() + kUnitHeaderBytes);
  UnitReader cut = reader_of(bytes);
  cut.set_max_unit_bytes(3);
  expect_error_at(cut.header_at(10), Errc::kInvalid, "R-LVL-07", "unit_size", 88);
  bytes[10] = static_cast<std::uint8_t>(bytes[10] | kAncillaryFlag);
  UnitReader ancillary = reader_of(bytes);
  ancillary.set_max_unit_bytes(3);
  expect_error_at(ancillary.header_at(10), Errc::kTruncated, "R-UNT-02", "unit_size", 88);
}

TEST(UnitReader, TheCrcCoversEveryBitOfTheUnit) {
  const Bytes stream = joined({kHeader, kUnit});
  for (std::size_t bit = 80; bit < 8 * stream.size(); ++bit) {
    if (bit / 8 >= 11 && bit / 8 < 15) continue;  // unit_size: the unit ends elsewhere
    Bytes wrong = stream;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (1U << (bit % 8)));
    UnitReader reader = reader_of(wrong);
    const auto unit = reader.header_at(10);
    ASSERT_TRUE(unit);
    expect_error_at(reader.payload(*unit), Errc::kInvalid, "R-UNT-03", "unit_crc", 152);
  }
  // One byte less: the CRC is read one byte early.
  Bytes smaller = stream;
  smaller[14] = 3;
  UnitReader reader = reader_of(smaller);
  const auto unit = reader.header_at(10);
  ASSERT_TRUE(unit);
  expect_error_at(reader.payload(*unit), Errc::kInvalid, "R-UNT-03", "unit_crc", 144);
}

TEST(UnitReader, PayloadStartGivesAtMostThePayload) {
  Bytes wrong = joined({kHeader, kUnit});
  wrong.back() ^= 1;  // the CRC is not checked
  UnitReader reader = reader_of(wrong);
  const auto unit = reader.header_at(10);
  ASSERT_TRUE(unit);
  const auto some = reader.payload_start(*unit, 3);
  ASSERT_TRUE(some);
  EXPECT_EQ(*some, (Bytes{0, 0, 0}));
  const auto all = reader.payload_start(*unit, 100);
  ASSERT_TRUE(all);
  EXPECT_EQ(*all, (Bytes{0, 0, 0, 7}));
}

TEST(UnitReader, TakesNoMemoryForLargerPayloadsThanAllowed) {
  const Bytes stream = joined({kHeader, kUnit});
  for (const std::uint64_t max_bytes : {0U, 3U, 4U}) {
    UnitReader reader(memory_source(Bytes(stream)), nullptr, max_bytes);
    const auto unit = reader.header_at(10);
    ASSERT_TRUE(unit);
    if (max_bytes < 4) {
      expect_error_at(reader.payload(*unit), Errc::kLimitExceeded, "", "unit_size", 88);
    } else {
      EXPECT_TRUE(reader.payload(*unit));
    }
    EXPECT_TRUE(reader.skip(*unit)) << max_bytes;
  }
}

TEST(UnitReader, CountsMemoryThatOthersUse) {
  UnitReader reader(memory_source(joined({kHeader, kUnit})), nullptr, 10);
  const auto unit = reader.header_at(10);
  ASSERT_TRUE(unit);
  reader.set_bytes_in_use(7);
  const auto payload = reader.payload(*unit);
  expect_error_at(payload, Errc::kLimitExceeded, "", "unit_size", 88);
  EXPECT_EQ(payload.error().needed_bytes, 11);
  reader.set_bytes_in_use(6);
  EXPECT_TRUE(reader.payload(*unit));
}

// Payload sizes around multiples of the block size.
TEST(UnitReader, SkipsUnitsWithAValidCrc) {
  for (const std::size_t size : {0U, 1U, 4090U, 4091U, 4092U, 8187U, 10000U}) {
    SCOPED_TRACE(size);
    Bytes payload(size);
    for (std::size_t i = 0; i < size; ++i) payload[i] = static_cast<std::uint8_t>(i * i);
    const Bytes unit_bytes = write_unit(UnitType::kMetadata, payload);
    // Damages the CRC, and the payload if any.
    for (std::size_t damaged = 0; 3 * damaged <= 4 + size && damaged < 3; ++damaged) {
      Bytes stream = joined({kHeader, unit_bytes, kUnit});
      if (damaged > 0) stream[stream.size() - kUnit.size() - damaged * 3] ^= 1;
      UnitReader reader = reader_of(stream);
      const auto unit = reader.header_at(10);
      ASSERT_TRUE(unit);
      if (damaged == 0) {
        EXPECT_TRUE(reader.skip(*unit));
      } else {
        expect_error_at(reader.skip(*unit), Errc::kInvalid, "R-UNT-03", "unit_crc",
                        (unit->end() - 4) * 8);
      }
    }
  }
}

class Log : public Trace {
 public:
  void begin(const char* structure, std::uint64_t bit_pos) override {
    text += std::string("[") + structure + "] " + std::to_string(bit_pos) + "\n";
  }
  void element(const char* name, std::int64_t value, std::uint64_t bit_pos) override {
    text += std::to_string(bit_pos) + " " + name + " " + std::to_string(value) + "\n";
  }
  std::string text;
};

TEST(UnitReader, TracesTheCrcAfterThePayload) {
  Log log;
  UnitReader reader = reader_of(joined({kHeader, kUnit}), &log);
  ASSERT_TRUE(reader.stream_header());
  const auto unit = reader.header_at(10);
  ASSERT_TRUE(unit);
  const auto payload = reader.payload(*unit);
  ASSERT_TRUE(payload);
  BitReader r = reader.bits(*unit, *payload);
  r.u(32, "index_distance");
  reader.flush_trace();
  reader.flush_trace();  // only once
  EXPECT_EQ(log.text,
            "[stream] 0\n64 version_major 1\n72 version_minor 0\n"
            "[unit] 80\n80 ancillary_flag 0\n81 unit_type 5\n88 unit_size 4\n"
            "120 index_distance 7\n152 unit_crc 3346686594\n");
}

// Source that fails, like a file on a disconnected disk.
class FailingSource : public ByteSource {
 public:
  std::uint64_t size() const override { return 1000; }
  bool read(std::uint64_t, std::span<std::uint8_t>) override { return false; }
};

TEST(UnitReader, AnUnreadableSourceIsNotABadStream) {
  UnitReader reader(std::make_unique<FailingSource>(), nullptr);
  const UnitHeader unit{5, 4, 10};
  expect_error_at(reader.stream_header(), Errc::kIo, "", "signature", 0);
  expect_error_at(reader.header_at(10), Errc::kIo, "", "unit_type", 80);
  expect_error_at(reader.payload(unit), Errc::kIo, "", "unit_payload", 120);
  expect_error_at(reader.payload_start(unit, 4), Errc::kIo, "", "unit_payload", 120);
}

}  // namespace
}  // namespace rlpc
