#include "common/files/numbered_name.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace rlpc {
namespace {

TEST(NumberedName, PadsWithZeros) {
  const auto name = parse_pattern("walk_%04d.obj");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->with(7), "walk_0007.obj");
  EXPECT_EQ(name->with(12345), "walk_12345.obj");
  const auto plain = parse_pattern("%d");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->with(0), "0");
  EXPECT_EQ(plain->with(std::numeric_limits<std::uint64_t>::max()), "18446744073709551615");
}

TEST(NumberedName, GivesBackTheNumber) {
  const auto name = parse_pattern("a%03d.ply");
  ASSERT_TRUE(name);
  for (const std::uint64_t number : {0U, 9U, 10U, 999U, 1000U, 4294967295U}) {
    EXPECT_EQ(name->number_of(name->with(number)), number);
  }
  for (const char* other : {"a01.ply", "a0001.ply", "a-01.ply", "a.ply", "b001.ply", "a001.obj",
                            "a001.ply2", "a18446744073709551616.ply", ""}) {
    EXPECT_EQ(name->number_of(other), std::nullopt) << other;
  }
}

TEST(NumberedName, TakesRunsOfAnimationPrograms) {
  const auto name = parse_pattern("walk.####.obj");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->with(7), "walk.0007.obj");
  EXPECT_EQ(name->number_of("walk.12345.obj"), 12345U);
  EXPECT_EQ(parse_pattern("f#.obj")->with(12), "f12.obj");
  EXPECT_EQ(parse_pattern("f#_%03d.obj")->with(12), "f#_012.obj");
  for (const char* pattern : {"f##_#.obj", "####################"}) {
    EXPECT_FALSE(parse_pattern(pattern)) << pattern;
    EXPECT_FALSE(is_pattern(pattern)) << pattern;
  }
  for (const char* pattern : {"f####", "%", "f_%x"}) EXPECT_TRUE(is_pattern(pattern));
  EXPECT_FALSE(is_pattern("f_0001.obj"));
}

TEST(NumberedName, AdvisesZerosInPlaceOfBlanks) {
  EXPECT_EQ(advice_on_pattern("f_%4d.obj"), "; for %4d, which pads with blanks, write %04d");
  for (const char* pattern : {"f_%04d.obj", "f_%d_%d", "f_%4x", "f_%4", "%", ""}) {
    EXPECT_EQ(advice_on_pattern(pattern), "") << pattern;
  }
}

TEST(NumberedName, RefusesOtherPatterns) {
  for (const char* pattern :
       {"", "walk.obj", "walk_%", "walk_%04", "walk_%x.obj", "walk_%4d.obj", "%d_%d.obj", "%d%",
        "%%d", "%020d", "%099999999999999999999d"}) {
    EXPECT_FALSE(parse_pattern(pattern)) << pattern;
  }
  EXPECT_TRUE(parse_pattern("%019d"));
}

}  // namespace
}  // namespace rlpc
