// Tests that preset slow never makes larger streams than medium, nor one GOF with it than two.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/parallel/for_each.h"
#include "conformance/testing/small_animation.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kTubeFrames = 30;

// A tube whose vertices swing in `modes` ways, which change after half of the time.
MemoryFrames changing_tube(std::uint32_t modes) {
  constexpr std::uint32_t kRings = 8;
  FrameSource::Shape shape;
  shape.frame_rate = {24, 1};
  shape.triangles = tube_triangles(kRings, 5);
  std::vector<std::vector<float>> frames;
  for (std::uint32_t f = 0; f < kTubeFrames; ++f) {
    std::vector<float> xyz;
    for (std::uint32_t v = 0; v < 5 * kRings; ++v) {
      const std::uint32_t ring = v / 5;
      double along = ring;
      double radius = 1.0;
      for (std::uint32_t m = 0; m < modes; ++m) {
        const double speed = 0.3 + 0.17 * m;
        const double phase = (f < kTubeFrames / 2 ? 1.7 : 2.9) * (m + 1.0) * v;
        along += 0.2 * std::sin(speed * f) * std::sin(phase);
        radius += 0.2 * std::sin(speed * f) * std::cos(1.3 * phase);
      }
      const double turn = 1.2566 * (v % 5);
      for (const double x : {along, radius * std::cos(turn), radius * std::sin(turn)}) {
        xyz.push_back(static_cast<float>(x));
      }
    }
    frames.push_back(std::move(xyz));
  }
  return {std::move(shape), std::move(frames)};
}

std::size_t bytes_of_tube(std::uint32_t modes, const EncoderSettings& settings) {
  MemoryFrames source = changing_tube(modes);
  return encode_to_memory(source, settings).size();
}

class PresetSlow : public testing::TestWithParam<Profile> {};
INSTANTIATE_TEST_SUITE_P(EachProfile, PresetSlow,
                         testing::Values(Profile::kMain, Profile::kHigh));

TEST_P(PresetSlow, KeepsTheSmallestOfItsSearches) {
  for (const std::uint32_t modes : {2U, 6U, 7U, 8U}) {
    SCOPED_TRACE(testing::Message() << modes << " modes");
    EncoderSettings settings;
    settings.profile = GetParam();
    settings.preset = Preset::kSlow;
    settings.gof_frames = EncoderSettings::kWholeSequence;
    const std::size_t one_gof = bytes_of_tube(modes, settings);
    settings.gof_frames = kTubeFrames / 2;
    EXPECT_LE(one_gof, bytes_of_tube(modes, settings));
    settings.preset = Preset::kMedium;
    EXPECT_LE(one_gof, bytes_of_tube(modes, settings));
    settings.gof_frames = EncoderSettings::kWholeSequence;
    EXPECT_LE(one_gof, bytes_of_tube(modes, settings));
  }
}

// The searches have their own threads; none must remain when they return.
TEST_P(PresetSlow, LeavesNoThreadsBehind) {
  for (const std::uint32_t modes : {2U, 6U, 7U, 8U}) {
    EncoderSettings settings;
    settings.profile = GetParam();
    settings.preset = Preset::kSlow;
    settings.gof_frames = EncoderSettings::kWholeSequence;
    settings.threads = 3;
    EXPECT_GT(bytes_of_tube(modes, settings), 0U);
    std::atomic<int> passes = 0;
    for_each(10, [&](std::size_t) { ++passes; });
    EXPECT_EQ(passes, 10);
  }
}

}  // namespace
}  // namespace rlpc
