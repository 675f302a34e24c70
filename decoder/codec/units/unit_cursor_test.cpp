#include "decoder/codec/units/unit_cursor.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/codec/syntax/write_units.h"

namespace rlpc {
namespace {

// A stream that consists of empty units of these types.
class UnitCursorTest : public testing::Test {
 protected:
  UnitCursor begin(const std::vector<UnitType>& types) {
    std::vector<std::uint8_t> bytes(kStreamHeaderBytes);
    for (const UnitType type : types) {
      const Bytes unit = write_unit(type, {});
      bytes.insert(bytes.end(), unit.begin(), unit.end());
    }
    size_ = bytes.size();
    reader_ = std::make_unique<UnitReader>(memory_source(std::move(bytes)), nullptr);
    return {*reader_, *reader_->header_at(kStreamHeaderBytes)};
  }

  // Advances to the end of the object; returns the number of its units.
  static std::size_t count(UnitCursor& cursor, const Followers& followers) {
    std::size_t units = 1;
    for (;; ++units) {
      const auto more = cursor.advance(followers);
      EXPECT_TRUE(more);
      if (!more || !*more) return units;
    }
  }

  std::uint64_t size_ = 0;
  std::unique_ptr<UnitReader> reader_;
};

constexpr auto kGof = UnitType::kGof;
constexpr auto kSlice = UnitType::kSlice;
constexpr auto kFrame = UnitType::kFrame;
constexpr auto kHash = UnitType::kGofHash;
constexpr auto kEnd = UnitType::kEndOfSequence;

TEST_F(UnitCursorTest, GoesOverSlicesAndOneHash) {
  struct Case {
    std::vector<UnitType> units;
    Followers followers;
    std::size_t expected;
  };
  const Case cases[] = {
      {{kGof, kEnd}, {kSlice, true}, 1},
      {{kGof, kSlice, kSlice, kEnd}, {kSlice, true}, 3},
      {{kGof, kSlice, kHash, kEnd}, {kSlice, true}, 3},
      {{kGof, kSlice, kHash, kEnd}, {kSlice, false}, 2},
      {{kGof, kHash, kHash, kEnd}, {kSlice, true}, 2},
      {{kGof, kHash, kSlice, kEnd}, {kSlice, true}, 2},
      {{kGof, kHash, kEnd}, {{}, true}, 2},
      {{kGof, kSlice, kEnd}, {{}, true}, 1},
      {{kGof, kSlice, kEnd}, {}, 1},
      {{kGof, kFrame, kSlice, kEnd}, {kFrame, true}, 2},
      {{kGof, kSlice, kGof, kSlice}, {kSlice, true}, 2},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(&c - cases);
    UnitCursor cursor = begin(c.units);
    EXPECT_EQ(count(cursor, c.followers), c.expected);
    const std::uint64_t unit_bytes = kUnitHeaderBytes + kUnitCrcBytes;
    EXPECT_EQ(cursor.end(), kStreamHeaderBytes + unit_bytes * c.expected);
    EXPECT_EQ(cursor.unit().type(), c.units[c.expected - 1]);
  }
}

TEST_F(UnitCursorTest, EndsWithTheStreamUnlessItMustGoOn) {
  UnitCursor cursor = begin({kGof, kSlice});
  EXPECT_EQ(count(cursor, {kSlice, true}), 2U);
  EXPECT_EQ(cursor.end(), size_);
  const auto more = cursor.advance({kSlice, false, true});
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, Errc::kTruncated);
  EXPECT_EQ(cursor.end(), size_);
}

}  // namespace
}  // namespace rlpc
