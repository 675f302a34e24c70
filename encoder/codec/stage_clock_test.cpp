#include "encoder/codec/stage_clock.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace rlpc {
namespace {

using std::chrono::milliseconds;

std::vector<std::string> names(const StageClock& clock) {
  std::vector<std::string> result;
  for (const StageTime& time : clock.times()) result.emplace_back(time.stage);
  return result;
}

double seconds(const StageClock& clock) {
  double sum = 0.0;
  for (const StageTime& time : clock.times()) sum += time.seconds;
  return sum;
}

TEST(StageClock, StagesWithinOthersCountOnce) {
  const StageClock clock;
  const auto start = std::chrono::steady_clock::now();
  {
    const Stage outer("outer");
    std::this_thread::sleep_for(milliseconds(2));
    for (int i = 0; i < 3; ++i) {
      const Stage inner("inner");
      std::this_thread::sleep_for(milliseconds(2));
    }
    const Stage again("outer");
  }
  const double sum = seconds(clock);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(names(clock), (std::vector<std::string>{"other", "outer", "inner"}));
  EXPECT_GE(clock.times()[1].seconds, 0.002);
  EXPECT_GE(clock.times()[2].seconds, 0.006);
  EXPECT_GE(sum, 0.008);
  EXPECT_LE(clock.times()[1].seconds + clock.times()[2].seconds, passed.count());
}

TEST(StageClock, AStageUnderWayIsTimed) {
  const StageClock clock;
  const Stage stage("here");
  const double before = clock.times()[1].seconds;
  std::this_thread::sleep_for(milliseconds(2));
  EXPECT_GE(clock.times()[1].seconds, before + 0.002);
}

TEST(StageClock, StagesOfOtherThreadsAreNotTimed) {
  const StageClock clock;
  std::thread other([] { const Stage stage("elsewhere"); });
  other.join();
  EXPECT_EQ(names(clock), std::vector<std::string>{"other"});
}

TEST(StageClock, ClocksOfAThreadAreApart) {
  const StageClock outer;
  const Stage first("first");
  {
    const StageClock inner;
    const Stage second("second");
    EXPECT_EQ(names(inner), (std::vector<std::string>{"other", "second"}));
  }
  const Stage third("third");
  EXPECT_EQ(names(outer), (std::vector<std::string>{"other", "first", "third"}));
}

TEST(StageClock, StagesNeedNone) {
  const Stage stage("alone");
  const StageClock clock;
  EXPECT_EQ(names(clock), std::vector<std::string>{"other"});
}

}  // namespace
}  // namespace rlpc
