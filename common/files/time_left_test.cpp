#include "common/files/time_left.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

TEST(ProgressText, RoundsMoreWhereMoreIsLeft) {
  EXPECT_EQ(progress_text(0.0, std::nullopt), "0 %");
  EXPECT_EQ(progress_text(0.429, std::nullopt), "42 %");
  EXPECT_EQ(progress_text(0.42, 80.0), "42 %, 1 min 20 s left");
  EXPECT_EQ(progress_text(0.99, 0.2), "99 %, 5 s left");
  EXPECT_EQ(progress_text(0.9, 13.0), "90 %, 15 s left");
  EXPECT_EQ(progress_text(0.9, 57.4), "90 %, 55 s left");
  EXPECT_EQ(progress_text(0.9, 58.0), "90 %, 1 min left");
  EXPECT_EQ(progress_text(0.9, 119.0), "90 %, 2 min left");
  EXPECT_EQ(progress_text(0.5, 3594.0), "50 %, 59 min 50 s left");
  EXPECT_EQ(progress_text(0.5, 3596.0), "50 %, 1 h left");
  EXPECT_EQ(progress_text(0.1, 7800.0), "10 %, 2 h 10 min left");
  EXPECT_EQ(progress_text(1.0, 0.0), "100 %");
}

TEST(TimeLeft, IsToldAfterSomeSeconds) {
  TimeLeft left;
  EXPECT_FALSE(left.update(0.0, 0.0));
  for (const double seconds : {0.5, 1.0, 1.5, 2.0, 2.5, 3.0}) {
    EXPECT_FALSE(left.update(seconds, seconds / 100)) << seconds;
  }
  ASSERT_TRUE(left.update(4.0, 0.04));
  EXPECT_NEAR(*left.update(4.2, 0.042), 95.8, 1e-9);
  for (int s = 5; s < 90; ++s) EXPECT_TRUE(left.update(s, s / 100.0)) << s;
  EXPECT_NEAR(*left.update(90.0, 0.9), 10.0, 1e-9);
  EXPECT_NEAR(*left.update(100.0, 1.0), 0.0, 1e-9);
}

TEST(TimeLeft, IsNotToldWhileThePaceChanges) {
  TimeLeft left;
  for (int s = 0; s <= 20; ++s) EXPECT_FALSE(left.update(s, s / 4000.0)) << s;
  for (int s = 21; s <= 24; ++s) EXPECT_FALSE(left.update(s, (s - 20) / 40.0)) << s;
}

TEST(TimeLeft, IsNotToldWhileNothingGoesOn) {
  TimeLeft left;
  for (int s = 0; s < 60; ++s) left.update(s, s / 100.0);
  EXPECT_TRUE(left.update(60, 0.6));
  for (int s = 61; s < 80; ++s) left.update(s, 0.6);
  for (int s = 80; s < 90; ++s) EXPECT_FALSE(left.update(s, 0.6)) << s;
}

TEST(TimeLeft, IsNotToldAfterASilence) {
  TimeLeft left;
  left.update(0, 0);
  for (int s = 200; s < 230; ++s) EXPECT_FALSE(left.update(s, (s - 199) / 100.0)) << s;
}

TEST(TimeLeft, FollowsThePace) {
  TimeLeft left;
  for (int s = 0; s < 40; ++s) left.update(s, s / 200.0);
  EXPECT_NEAR(*left.update(40, 0.2), 160.0, 1e-9);
  for (int s = 41; s < 60; ++s) left.update(s, 0.2 + (s - 40) / 160.0);
  const auto faster = left.update(60, 0.2 + 20 / 160.0);  // 108 s are left at this pace
  ASSERT_TRUE(faster);
  EXPECT_GT(*faster, 108.0);
  EXPECT_LT(*faster, 124.7);
}

TEST(TimeLeft, IsNotToldAtTheVeryBeginning) {
  TimeLeft left;
  for (int s = 1; s <= 100; ++s) EXPECT_FALSE(left.update(s, 0.009));
}

}  // namespace
}  // namespace rlpc
