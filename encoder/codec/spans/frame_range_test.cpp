#include "encoder/codec/spans/frame_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

TEST(EqualSpans, CoverAllFramesInOrder) {
  for (std::uint32_t frames = 1; frames <= 40; ++frames) {
    for (std::uint32_t count = 1; count <= frames; ++count) {
      const std::vector<FrameRange> spans = equal_ranges(frames, count);
      ASSERT_EQ(spans.size(), count);
      std::uint32_t next = 0;
      std::uint32_t shortest = frames;
      std::uint32_t longest = 0;
      for (const FrameRange& span : spans) {
        EXPECT_EQ(span.first, next);
        EXPECT_EQ(span.num_gofs, 1U);
        next += span.count;
        shortest = std::min(shortest, span.count);
        longest = std::max(longest, span.count);
      }
      EXPECT_EQ(next, frames);
      EXPECT_GE(shortest, 1U);
      EXPECT_LE(longest - shortest, 1U);
    }
  }
}

TEST(EqualSpans, DoNotOverflow) {
  const std::vector<FrameRange> spans = equal_ranges(1U << 24, 1U << 20);
  ASSERT_EQ(spans.size(), 1U << 20);
  EXPECT_EQ(spans.back().first, (1U << 24) - 16);
  EXPECT_EQ(spans.back().count, 16U);
}

TEST(EqualGofs, AreAsFewAsPossible) {
  for (std::uint32_t frames = 1; frames <= 60; ++frames) {
    for (std::uint32_t longest = 1; longest <= 20; ++longest) {
      const std::vector<FrameRange> gofs = equal_gofs(frames, longest);
      EXPECT_EQ(gofs.size(), (frames + longest - 1) / longest);
      for (const FrameRange& gof : gofs) EXPECT_LE(gof.count, longest);
    }
  }
}

}  // namespace
}  // namespace rlpc
