#include "common/parallel/for_each.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace rlpc {
namespace {

TEST(ForEach, RunsEveryPassOnce) {
  for (const std::uint32_t count : {1U, 2U, 3U, 7U}) {
    const Threads threads(count);
    for (const std::size_t passes : {0U, 1U, 2U, 5U, 1000U}) {
      std::vector<std::atomic<int>> calls(passes);
      for_each(passes, [&](std::size_t i) { ++calls[i]; });
      for (const auto& n : calls) EXPECT_EQ(n, 1) << count << " " << passes;
    }
  }
}

TEST(ForEach, RunsWithoutThreads) {
  std::size_t sum = 0;
  for_each(10, [&](std::size_t i) { sum += i; });
  EXPECT_EQ(sum, 45U);
}

// Two passes wait for each other, which only two threads can do.
TEST(ForEach, UsesSeveralThreads) {
  const Threads threads(2);
  std::atomic<int> arrived = 0;
  for_each(2, [&](std::size_t) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 2);
}

// A thread that waits for the inner loop of one pass must not begin another outer pass: it
// would then hold two GOFs.
TEST(ForEach, HasAtMostOnePassOfEachDepthPerThread) {
  constexpr std::uint32_t kThreads = 3;
  const Threads threads(kThreads);
  std::atomic<int> outer = 0;
  std::atomic<int> max = 0;
  std::atomic<int> inner = 0;
  for_each(40, [&](std::size_t) {
    int now = ++outer;
    for (int before = max; now > before && !max.compare_exchange_weak(before, now);) {
    }
    for_each(5, [&](std::size_t) {
      for_each(3, [&](std::size_t) {
        ++inner;
        std::this_thread::yield();
      });
    });
    --outer;
  });
  EXPECT_EQ(inner, 40 * 5 * 3);
  EXPECT_LE(max, static_cast<int>(kThreads));
}

TEST(ForEach, RethrowsOnceNoPassRuns) {
  for (const std::uint32_t count : {1U, 3U}) {
    const Threads threads(count);
    std::atomic<int> running = 0;
    std::atomic<int> begun = 0;
    EXPECT_THROW(for_each(1000,
                          [&](std::size_t i) {
                            ++begun;
                            ++running;
                            for_each(2, [&](std::size_t k) {
                              if (i == 7 && k == 1) {
                                --running;
                                throw std::runtime_error("seven");
                              }
                            });
                            --running;
                          }),
                 std::runtime_error);
    EXPECT_EQ(running, 0);
    if (count == 1) {
      EXPECT_EQ(begun, 8);
    }
    // The threads continue.
    std::atomic<int> calls = 0;
    for_each(100, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 100);
  }
}

TEST(ForRanges, CoverEveryNumberOnce) {
  const Threads threads(3);
  for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 100U}) {
    std::vector<std::atomic<int>> calls(count);
    for_ranges(count, 16, [&](std::size_t first, std::size_t end) {
      EXPECT_LE(end - first, 16U);
      for (std::size_t i = first; i < end; ++i) ++calls[i];
    });
    for (const auto& n : calls) EXPECT_EQ(n, 1) << count;
  }
}

}  // namespace
}  // namespace rlpc
