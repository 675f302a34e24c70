#include "encoder/codec/sequence/choices/gof_cuts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

constexpr std::uint32_t kVertices = 600;

// A source whose coordinates are a function of frame, vertex and axis.
class Motion final : public FrameSource {
 public:
  using At = std::function<double(std::uint32_t f, std::uint32_t v, std::uint32_t c)>;
  Motion(std::uint32_t num_frames, At at)
      : FrameSource({kVertices, num_frames, {25, 1}, {}}), at_(std::move(at)) {}
  std::optional<InputError> read_frame(std::uint32_t f, std::span<float> xyz) override {
    if (f == broken) return InputError{"no such frame"};
    for (std::uint32_t v = 0; v < kVertices; ++v) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        xyz[3 * std::size_t{v} + c] = static_cast<float>(at_(f, v, c));
      }
    }
    return std::nullopt;
  }
  std::uint32_t broken = 0xFFFFFFFF;

 private:
  At at_;
};

// Returns a sum of waves; each act has different ones.
double waves(std::uint32_t act, std::uint32_t f, std::uint32_t v, std::uint32_t c) {
  double x = v % 25 + 30.0 * c;
  for (std::uint32_t k = 1; k <= 8; ++k) {
    x += std::sin((0.7 * k + 0.31 * act) * v + c) * std::sin(0.4 * k * f + k);
  }
  return x;
}

void expect_whole(const std::vector<FrameRange>& spans, std::uint32_t num_frames,
                  std::uint32_t longest) {
  std::uint32_t next = 0;
  for (const FrameRange& span : spans) {
    EXPECT_EQ(span.first, next);
    EXPECT_GE(span.count, 1U);
    EXPECT_LE(span.count, longest);
    next += span.count;
  }
  EXPECT_EQ(next, num_frames);
}

TEST(EqualGofs, DifferByAFrameAtMost) {
  for (const std::uint32_t num_frames : {1U, 7U, 128U, 129U, 1000U}) {
    for (const std::uint32_t longest : {1U, 3U, 128U, 1000U}) {
      const auto spans = equal_gofs(num_frames, longest);
      expect_whole(spans, num_frames, longest);
      EXPECT_EQ(spans.size(), (num_frames + longest - 1) / longest);
      for (const FrameRange& span : spans) {
        EXPECT_LE(span.count, num_frames / spans.size() + 1);
        EXPECT_GE(span.count, num_frames / spans.size());
      }
    }
  }
}

TEST(CheapestGofs, CutsWhereTheMotionChanges) {
  constexpr std::uint32_t kFirstCut = 90;
  constexpr std::uint32_t kSecondCut = 210;
  constexpr std::uint32_t kFrames = 270;
  Motion source(kFrames, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
    return waves(f < kFirstCut ? 1 : f < kSecondCut ? 2 : 3, f, v, c);
  });
  const auto spans = cheapest_gofs(source, 128, 0.05);
  ASSERT_TRUE(spans);
  expect_whole(*spans, kFrames, 128);
  ASSERT_EQ(spans->size(), 3U);
  EXPECT_NEAR((*spans)[1].first, kFirstCut, 4.0);
  EXPECT_NEAR((*spans)[2].first, kSecondCut, 4.0);
}

TEST(CheapestGofs, AreEqualIfCutsMakeNoDifference) {
  Motion source(300, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
    return waves(1, 0, v, c) + 0.1 * f;  // pure translation
  });
  const auto spans = cheapest_gofs(source, 128, 0.05);
  ASSERT_TRUE(spans);
  ASSERT_EQ(spans->size(), 3U);
  for (const FrameRange& span : *spans) EXPECT_EQ(span.count, 100U);
}

TEST(CheapestGofs, IsASingleGofIfTheSequenceIsShort) {
  Motion source(100, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
    return waves(f / 50, f, v, c);
  });
  const auto spans = cheapest_gofs(source, 100, 0.05);
  ASSERT_TRUE(spans);
  EXPECT_EQ(spans->size(), 1U);
}

TEST(CheapestGofs, PassesOnTheErrorOfTheSource) {
  Motion source(300, [](std::uint32_t, std::uint32_t, std::uint32_t) { return 1.0; });
  source.broken = 200;
  const auto spans = cheapest_gofs(source, 128, 0.05);
  ASSERT_FALSE(spans);
  EXPECT_EQ(spans.error().message, "no such frame");
}

TEST(CheapestGofs, DividesVeryLongSequencesEquallyWithoutReading) {
  Motion source(100'000, [](std::uint32_t, std::uint32_t, std::uint32_t) { return 1.0; });
  source.broken = 0;
  const auto spans = cheapest_gofs(source, 128, 0.05);
  ASSERT_TRUE(spans);
  EXPECT_EQ(spans->size(), equal_gofs(100'000, 128).size());
}

TEST(ChooseLongestGof, IsLongWhereEachGofWouldOnlyCodeTheShapeAgain) {
  Motion still(1000, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
    return (v * 37 % 101) + 5.0 * c + (v < kVertices / 8 ? std::sin(0.05 * f) : 0.0);
  });
  const auto longest = choose_longest_gof(still, 128, 4096, 0.01);
  ASSERT_TRUE(longest);
  EXPECT_GE(*longest, 1000U);
  const auto limited = choose_longest_gof(still, 128, 500, 0.01);
  ASSERT_TRUE(limited);
  EXPECT_EQ(*limited, 500U);
}

TEST(ChooseLongestGof, IsShortWhereLongOnesSaveLittle) {
  // Noise from the bits of a sum that mixes frame, vertex and axis.
  Motion noise(512, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
    std::uint32_t x = f * 2654435761U + v * 40503U + c * 97U;
    x ^= x >> 13U;
    x *= 2246822519U;
    x ^= x >> 16U;
    return x % 1000;
  });
  const auto longest = choose_longest_gof(noise, 128, 4096, 0.01);
  ASSERT_TRUE(longest);
  EXPECT_EQ(*longest, 128U);
}

TEST(ChooseLongestGof, IsTheShortestForFewFrames) {
  Motion few(100,
             [](std::uint32_t f, std::uint32_t v, std::uint32_t c) { return 1.0 * f + v + c; });
  const auto longest = choose_longest_gof(few, 128, 4096, 0.01);
  ASSERT_TRUE(longest);
  EXPECT_EQ(*longest, 128U);
}

TEST(ChooseLongestGof, PassesOnErrorsOfTheSource) {
  Motion broken(300, [](std::uint32_t, std::uint32_t v, std::uint32_t) { return 1.0 * v; });
  broken.broken = 7;
  EXPECT_FALSE(choose_longest_gof(broken, 128, 4096, 0.01));
}

}  // namespace
}  // namespace rlpc
