// Reading with a RuleListener: values that break a rule are reported, and reading goes on.
#include "common/codec/bits/rule_listener.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/bits/bit_reader.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

class RuleLog final : public RuleListener {
 public:
  std::vector<std::string> lines;

 private:
  void broken_rule(const Error& error, std::int64_t value, Range allowed) override {
    lines.push_back(std::string(error.rule) + ' ' + error.element + " at " +
                    std::to_string(error.bit_pos) + ": " + std::to_string(value) + " not " +
                    std::to_string(allowed.min) + " to " + std::to_string(allowed.max));
  }
  void failed(const Error& error) override {
    lines.push_back(std::string(error.rule) + ' ' + error.element + " at " +
                    std::to_string(error.bit_pos));
  }
};

struct Reading {
  explicit Reading(Bytes payload)
      : bytes(std::move(payload)), reader(bytes, 100, nullptr, &log) {}

  Bytes bytes;
  RuleLog log;
  BitReader reader;
};

using Lines = std::vector<std::string>;

TEST(RuleListener, LearnsOfAllValuesOutOfRange) {
  Reading of({0b1010'0010, 0b0110'0000});  // u(4) 10, ue() 3, u(1) 1, u(1) 1
  EXPECT_EQ(of.reader.u(4, "a", {0, 8}, "R-A"), 10U);
  EXPECT_EQ(of.reader.ue("b", {4, 7}, "R-B"), 3U);
  EXPECT_TRUE(of.reader.flag("c"));
  EXPECT_FALSE(of.reader.stopped());
  EXPECT_EQ(of.log.lines, (Lines{"R-A a at 100: 10 not 0 to 8", "R-B b at 104: 3 not 4 to 7"}));
  ASSERT_TRUE(of.reader.error());
  EXPECT_STREQ(of.reader.error()->rule, "R-A");
}

TEST(RuleListener, LearnsOfTheEndAfterBrokenRules) {
  Reading of({0b1010'0010});
  of.reader.u(4, "a", {0, 8}, "R-A");
  EXPECT_EQ(of.reader.u(5, "b", {2, 7}, "R-B"), 2U);
  EXPECT_EQ(of.reader.u(1, "c", {1, 1}, "R-C"), 1U);
  EXPECT_TRUE(of.reader.stopped());
  EXPECT_EQ(of.log.lines, (Lines{"R-A a at 100: 10 not 0 to 8", "R-BIT-01 b at 104"}));
  EXPECT_STREQ(of.reader.error()->rule, "R-A");
}

TEST(RuleListener, ReadingStopsWhereElementsDependOnTheValue) {
  Reading of({0b1010'0010});
  EXPECT_EQ(of.reader.u(4, "a", {0, 8}, "R-A", AfterBroken::kStop), 0U);
  EXPECT_TRUE(of.reader.stopped());
  EXPECT_EQ(of.reader.u(4, "b", {3, 3}, "R-B"), 3U);
  of.reader.fail(Errc::kInvalid, "R-C", "c", 0);
  EXPECT_EQ(of.log.lines, (Lines{"R-A a at 100: 10 not 0 to 8"}));
  Reading legal({0b1010'0010});
  EXPECT_EQ(legal.reader.u(4, "a", {0, 10}, "R-A", AfterBroken::kStop), 10U);
  EXPECT_FALSE(legal.reader.stopped());
}

TEST(RuleListener, AnElementBreaksOneRule) {
  Reading of({0b1010'0010});
  of.reader.u(4, "a", {0, 8}, "R-A");
  EXPECT_FALSE(of.reader.require({"a", 10, 100}, false, "R-B"));
  EXPECT_FALSE(of.reader.require({"a", 10, 100}, true, "R-B"));
  const std::int64_t b = of.reader.u(4, "b");
  EXPECT_TRUE(of.reader.require({"b", b, 104}, b == 2, "R-B"));
  EXPECT_FALSE(of.reader.require({"b", b, 104}, {3, 9}, "R-C"));
  EXPECT_EQ(of.log.lines, (Lines{"R-A a at 100: 10 not 0 to 8", "R-C b at 104: 2 not 3 to 9"}));
}

TEST(RuleListener, LearnsOfAlignmentAndOfWhatIsLeft) {
  Reading of({0b1010'0010, 0, 0});
  of.reader.u(4, "a");
  of.reader.byte_alignment();
  of.reader.expect_end();
  EXPECT_FALSE(of.reader.stopped());
  EXPECT_EQ(of.log.lines, (Lines{"R-BIT-02 alignment_zero_bits at 104: 2 not 0 to 0",
                                 "R-BIT-03 unit_payload at 108: 16 not 0 to 0"}));
}

// 2^33 - 2, the largest code of 9.2, is beyond what ue() returns.
TEST(RuleListener, HugeCodesStayWithin32Bits) {
  Reading of({0, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0x80});
  EXPECT_EQ(of.reader.ue("a", {0, 5}, "R-A"), 0xFFFFFFFEU);
  EXPECT_EQ(of.log.lines, (Lines{"R-A a at 100: 8589934590 not 0 to 5"}));
}

TEST(RuleListener, IsNotNeeded) {
  const Bytes bytes{0b1010'0010};
  BitReader reader(bytes);
  EXPECT_EQ(reader.u(4, "a", {0, 8}, "R-A"), 0U);
  EXPECT_TRUE(reader.stopped());
  EXPECT_FALSE(reader.require({"a", 1, 0}, true, "R-B"));
  EXPECT_STREQ(reader.error()->rule, "R-A");
}

}  // namespace
}  // namespace rlpc
