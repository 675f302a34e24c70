#include "decoder/codec/parse/sequence/parse_clip_table.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "common/codec/bits/bit_writer.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Writes clips "ab" of frames 2 to 4, and "c" of frame 0.
Bytes table() {
  BitWriter w;
  w.ue(1);
  w.se(2);
  w.ue(2);
  w.u(8, 1);
  w.u(8, 'a');
  w.u(8, 'b');
  w.se(-5);
  w.ue(0);
  w.u(8, 0);
  w.u(8, 'c');
  w.byte_alignment();
  return w.take();
}

Result<std::vector<Clip>> clips_in(const Bytes& payload, std::uint32_t num_frames) {
  BitReader r(payload);
  return parse_clip_table(r, num_frames, {UINT64_MAX, 0});
}

TEST(ParseClipTable, GivesNamesAndFrames) {
  const auto clips = clips_in(table(), 5);
  ASSERT_TRUE(clips);
  EXPECT_EQ(*clips, (std::vector<Clip>{{"ab", 2, 3}, {"c", 0, 1}}));
}

TEST(ParseClipTable, ClipsLieWithinTheSequence) {
  for (const std::uint32_t num_frames : {1U, 2U, 4U}) {
    const auto clips = clips_in(table(), num_frames);
    ASSERT_FALSE(clips);
    EXPECT_EQ(clips.error().rule, std::string("R-CLP-02"));
    EXPECT_EQ(clips.error().element,
              std::string(num_frames < 3 ? "clip_gap" : "clip_num_frames_minus1"));
  }
}

TEST(ParseClipTable, EveryProperPrefixFails) {
  const Bytes whole = table();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const auto clips =
        clips_in(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)), 5);
    ASSERT_FALSE(clips);
    EXPECT_EQ(clips.error().rule, std::string("R-BIT-01"));
  }
}

TEST(ParseClipTable, NothingFollows) {
  Bytes longer = table();
  longer.push_back(0);
  const auto clips = clips_in(longer, 5);
  ASSERT_FALSE(clips);
  EXPECT_EQ(clips.error().rule, std::string("R-BIT-03"));
}

TEST(ParseClipTable, AnEndlessTableEndsAtItsLimit) {
  BitWriter w;
  w.ue(kMaxClips);
  w.byte_alignment();
  const auto clips = clips_in(w.take(), 5);
  ASSERT_FALSE(clips);
  EXPECT_EQ(clips.error().rule, std::string("R-CLP-01"));
}

}  // namespace
}  // namespace rlpc
