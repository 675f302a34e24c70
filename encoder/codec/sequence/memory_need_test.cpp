#include "encoder/codec/sequence/memory_need.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

EncoderSettings settings_with_clips(Profile profile, std::size_t num_clips) {
  EncoderSettings settings;
  settings.profile = profile;
  settings.clips.resize(num_clips);
  return settings;
}

TEST(LongestGof, IsThatOfTheProfile) {
  EXPECT_EQ(longest_gof(settings_with_clips(Profile::kBaseline, 3), 100), 128);
  EXPECT_EQ(longest_gof(settings_with_clips(Profile::kMain, 0), 100), 128);
  EXPECT_EQ(longest_gof(settings_with_clips(Profile::kMain, 1), 100), 128);
  EXPECT_EQ(longest_gof(settings_with_clips(Profile::kHigh, 3), 100), 256);
}

TEST(LongestGof, WithSeveralClipsIsWhatMemoryAllows) {
  EncoderSettings settings = settings_with_clips(Profile::kMain, 2);
  EXPECT_EQ(longest_gof(settings, 100), 4096);
  EXPECT_EQ(longest_gof(settings, 1U << 15), 2048);
  EXPECT_EQ(longest_gof(settings, 1U << 20), 128);
  settings.max_memory_bytes = std::uint64_t{380} << 20;
  EXPECT_EQ(longest_gof(settings, 1U << 10), 1024);
}

TEST(LongestGof, OfAKnownSequenceIsWhatMemoryAllows) {
  EXPECT_EQ(longest_gof_of_all(settings_with_clips(Profile::kMain, 0), 100), 4096);
  EXPECT_EQ(longest_gof_of_all(settings_with_clips(Profile::kMain, 1), 1U << 15), 2048);
  EXPECT_EQ(longest_gof_of_all(settings_with_clips(Profile::kBaseline, 0), 100), 128);
  EXPECT_EQ(longest_gof_of_all(settings_with_clips(Profile::kHigh, 0), 100), 256);
}

TEST(LongestGof, IsTheOneAskedFor) {
  EncoderSettings settings = settings_with_clips(Profile::kMain, 2);
  settings.gof_frames = 7;
  EXPECT_EQ(longest_gof(settings, 100), 7);
}

}  // namespace
}  // namespace rlpc
