#include "encoder/codec/kinds/inter/frame_pattern_text.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

TEST(FramePatternText, Words) {
  EXPECT_EQ(parse_frame_pattern_text("previous")->kind, FramePattern::kPrevious);
  EXPECT_EQ(parse_frame_pattern_text("first")->kind, FramePattern::kFirst);
  const auto dyadic = parse_frame_pattern_text("dyadic:16");
  ASSERT_TRUE(dyadic);
  EXPECT_EQ(dyadic->kind, FramePattern::kDyadic);
  EXPECT_EQ(dyadic->period_log2, 4);
}

TEST(FramePatternText, Entries) {
  const auto pattern = parse_frame_pattern_text("2<0,1<0+2@1");
  ASSERT_TRUE(pattern);
  EXPECT_EQ(pattern->kind, FramePattern::kExplicit);
  const std::vector<PatternEntry> expected{{2, {0, 0}, 0}, {1, {0, 2}, 1}};
  EXPECT_EQ(pattern->entries, expected);
}

TEST(FramePatternText, IsWrittenAsItIsRead) {
  for (const char* const text : {"previous", "first", "dyadic:2", "dyadic:64", "1<0",
                                 "2<0,1<0+2@1", "4<0,2<0+4@1,1<0+2@2,3<2+4@2"}) {
    EXPECT_EQ(frame_pattern_text(*parse_frame_pattern_text(text)), text);
  }
}

TEST(FramePatternText, IsReadToItsEnd) {
  for (const char* const text : {"", "next", "dyadic", "dyadic:", "dyadic:12", "dyadic:8x", "1",
                                 "1<", "1<0,", "1<0+", "1<0@", "1<0@1x", "<0", "1<0 2<0"}) {
    EXPECT_FALSE(parse_frame_pattern_text(text)) << text;
  }
}

}  // namespace
}  // namespace rlpc
