#include "common/files/clip_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace rlpc {
namespace {

TEST(ClipTime, FramesTakeOneIntervalLess) {
  EXPECT_EQ(clip_seconds({30, 1}, 31), 1.0);
  EXPECT_EQ(clip_seconds({30, 1}, 1), 0.0);
  EXPECT_DOUBLE_EQ(clip_seconds({30000, 1001}, 30001), 1001.0);
}

TEST(ClipTime, IsHeldAtTheEndOrStartsAgain) {
  const FrameRate rate{10, 1};
  EXPECT_DOUBLE_EQ(clip_place(rate, 11, 0.25, false), 2.5);
  EXPECT_EQ(clip_place(rate, 11, 1.0, false), 10.0);
  EXPECT_EQ(clip_place(rate, 11, 7.0, false), 10.0);
  EXPECT_EQ(clip_place(rate, 11, 1.0, true), 0.0);
  EXPECT_NEAR(clip_place(rate, 11, 3.25, true), 2.5, 1e-12);
  EXPECT_EQ(clip_place(rate, 11, -1.0, true), 0.0);
  EXPECT_EQ(clip_place(rate, 1, 5.0, true), 0.0);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(clip_place(rate, 11, infinity, false), 10.0);
  EXPECT_LT(clip_place(rate, 11, infinity, true), 10.0);
}

TEST(ClipTime, RoundedTimesOfFramesAreThoseOfFrames) {
  for (const FrameRate rate : {FrameRate{30, 1}, {30000, 1001}, {24, 1}, {7, 3}, {997, 991}}) {
    for (std::uint32_t k = 0; k < 1000; ++k) {
      const double seconds =
          static_cast<double>(k) / (static_cast<double>(rate.numerator) / rate.denominator);
      for (const double time :
           {seconds, std::nextafter(seconds, 0.0), std::nextafter(seconds, 1e9)}) {
        ASSERT_EQ(clip_place(rate, 1001, time, false), k);
        ASSERT_EQ(clip_place(rate, 101, time, true), k % 100);
      }
      const double middle = (k + 0.5) * rate.denominator / rate.numerator;
      for (const double time : {middle, std::nextafter(middle, 0.0)}) {
        ASSERT_EQ(nearest_frame(clip_place(rate, 1001, time, false)), k + 1);
      }
    }
  }
}

TEST(ClipTime, RandomPlacesAreWithinTheClip) {
  std::mt19937 random(3);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random()) % n; };
  for (int i = 0; i < 100000; ++i) {
    const FrameRate rate{1 + below(100000), 1 + below(2000)};
    const std::uint32_t num_frames = 2 + below(i % 2 == 0 ? 100 : 1000000);
    const double seconds = static_cast<double>(random()) * (i % 3 == 0 ? 1.0 : 1e-7);
    const double intervals = seconds * rate.numerator / rate.denominator;
    const double last = num_frames - 1.0;
    const double place = clip_place(rate, num_frames, seconds, true);
    ASSERT_GE(place, 0.0);
    ASSERT_LT(place, last);
    const double off = std::abs(place - std::fmod(intervals, last));
    ASSERT_LT(std::min(off, last - off), 1e-15 * intervals + 1.1e-6);
    ASSERT_NEAR(clip_place(rate, num_frames, seconds, false), std::min(intervals, last),
                1.1e-6);
  }
}

}  // namespace
}  // namespace rlpc
