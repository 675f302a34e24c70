// Tests sequences of several spans in which later ones use shared rigs of earlier ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "conformance/testing/frame_by_frame.h"
#include "conformance/testing/small_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kRings = 60;
constexpr std::uint32_t kSides = 8;

using Move = std::function<std::array<double, 3>(double x, double y, double z, double f)>;

// A tube along x whose parts move by themselves.
MemoryFrames moving_tube(std::uint32_t num_frames, const Move& move) {
  FrameSource::Shape shape;
  shape.frame_rate = {24, 1};
  shape.triangles = tube_triangles(kRings, kSides);
  std::vector<std::vector<float>> frames;
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    std::vector<float> xyz;
    for (std::uint32_t v = 0; v < kRings * kSides; ++v) {
      const double turn = 0.785398 * (v % kSides);
      const double radius = 0.2 + 0.02 * std::sin(1.7 * v);
      const std::uint32_t ring = v / kSides;
      const auto p =
          move(4.0 * ring / kRings - 2.0, radius * std::cos(turn), radius * std::sin(turn), f);
      for (const double c : p) xyz.push_back(static_cast<float>(c));
    }
    frames.push_back(std::move(xyz));
  }
  return {std::move(shape), std::move(frames)};
}

// Repeats itself about every 31 frames, but not exactly.
std::array<double, 3> bent(double x, double y, double z, double f) {
  const double bend = 0.8 * std::sin(0.2 * f) * std::tanh(4.0 * x);
  const double swell = 1.0 + 0.2 * std::sin(0.4 * f + 2.0 * x);
  return {std::cos(bend) * x - std::sin(bend) * y * swell + 0.01 * f,
          std::sin(bend) * x + std::cos(bend) * y * swell, z * swell};
}

// Adds another deformation from some frame on.
Move changing(double from) {
  return [from](double x, double y, double z, double f) {
    auto p = bent(x, y, z, f);
    if (f >= from) p[2] += 0.15 * std::sin(0.33 * f) * std::sin(3.0 * x + 0.05 * f);
    return p;
  };
}

EncoderSettings rig_settings(std::uint32_t gof_frames, std::uint32_t threads = 1) {
  EncoderSettings settings;
  settings.profile = Profile::kHigh;
  settings.preset = Preset::kFast;
  settings.target = {Target::kKg, 0.3};
  settings.gof_frames = gof_frames;
  settings.hash_mode = HashMode::kFrame;
  settings.threads = threads;
  return settings;
}

StreamBytes stream_by_frames(FrameSource& source, const EncoderSettings& settings,
                             std::uint32_t held) {
  const Encoded encoded = encode_frames(source, settings, held);
  EXPECT_TRUE(encoded.report.target_met);
  if (settings.target.kind == Target::kKg) {
    EXPECT_LE(encoded.report.metrics.kg_error_percent, settings.target.value);
  }
  return encoded.bytes;
}

std::size_t count(const StreamBytes& bytes, UnitType type) {
  const auto units = units_of(bytes);
  return static_cast<std::size_t>(std::count_if(
      units.begin(), units.end(), [&](const UnitPlace& unit) { return unit.type == type; }));
}

using DecodedFrames = std::vector<std::vector<std::int32_t>>;

// Decodes all frames and compares the hash of each.
DecodedFrames decode_with_hashes(const StreamBytes& bytes) {
  auto decoder = Decoder::open(memory_source(bytes));
  if (!decoder) throw std::logic_error("the stream does not open");
  DecodedFrames frames;
  std::vector<std::int32_t> positions(3 * std::size_t{decoder->header().num_vertices});
  for (auto more = decoder->next_frame(positions); more && *more;
       more = decoder->next_frame(positions)) {
    EXPECT_EQ(decoder->compared_frames(), 1U);
    frames.push_back(positions);
  }
  EXPECT_EQ(frames.size(), decoder->header().num_frames);
  return frames;
}

TEST(SpanRigs, RepeatedMotionHasOneRig) {
  MemoryFrames source = moving_tube(192, bent);
  MemoryFrames first = moving_tube(64, bent);
  const StreamBytes whole = stream_by_frames(source, rig_settings(32), 64);
  EXPECT_EQ(count(whole, UnitType::kRig), 1U);
  EXPECT_EQ(count(whole, UnitType::kGof), 6U);
  // This is much less than a rig for each span takes.
  EXPECT_LT(whole.size(),
            2.2 * static_cast<double>(stream_by_frames(first, rig_settings(32), 64).size()));
  EXPECT_EQ(decode_with_hashes(whole).size(), 192U);
}

// A span of a single GOF has its own vertices if nothing follows, otherwise a shared rig.
TEST(SpanRigs, SpansMayBeSingleGofs) {
  MemoryFrames source = moving_tube(96, bent);
  const StreamBytes bytes = stream_by_frames(source, rig_settings(32), 32);
  EXPECT_EQ(count(bytes, UnitType::kRig), 1U);
  EXPECT_EQ(count(bytes, UnitType::kGof), 3U);
  EXPECT_EQ(decode_with_hashes(bytes).size(), 96U);
}

// Takes little more than separate sequences of the parts.
TEST(SpanRigs, ChangedMotionIsCodedAsWell) {
  MemoryFrames source = moving_tube(128, changing(64.0));
  MemoryFrames first = moving_tube(64, bent);
  const StreamBytes whole = stream_by_frames(source, rig_settings(64), 64);
  const StreamBytes before = stream_by_frames(first, rig_settings(64), 64);
  MemoryFrames late = moving_tube(64, [](double x, double y, double z, double f) {
    return changing(0.0)(x, y, z, f + 64.0);
  });
  const StreamBytes after = stream_by_frames(late, rig_settings(64), 64);
  EXPECT_LT(whole.size(), before.size() + after.size());
  EXPECT_EQ(decode_with_hashes(whole).size(), 128U);
}

TEST(SpanRigs, SeeksReachLaterSpans) {
  MemoryFrames source = moving_tube(128, changing(96.0));
  // Enough GOFs for an index.
  const StreamBytes bytes = stream_by_frames(source, rig_settings(4), 32);
  EXPECT_GE(count(bytes, UnitType::kGofIndex), 1U);
  EXPECT_LT(count(bytes, UnitType::kRig), 4U);
  const DecodedFrames frames = decode_with_hashes(bytes);
  std::vector<std::int32_t> positions(frames[0].size());
  for (const std::uint32_t f : {127U, 40U, 65U, 3U, 100U, 31U, 32U}) {
    auto decoder = Decoder::open(memory_source(bytes));
    ASSERT_TRUE(decoder);
    ASSERT_TRUE(decoder->seek(f));
    ASSERT_TRUE(*decoder->next_frame(positions)) << f;
    EXPECT_EQ(positions, frames[f]) << f;
  }
}

TEST(SpanRigs, ThreadsGiveTheSameBytes) {
  MemoryFrames source = moving_tube(96, changing(50.0));
  EXPECT_EQ(stream_by_frames(source, rig_settings(16, 1), 32),
            stream_by_frames(source, rig_settings(16, 2), 32));
}

TEST(SpanRigs, MeetOtherTargets) {
  MemoryFrames source = moving_tube(96, changing(70.0));
  for (const Target& target : {Target{Target::kMaxError, 0.01}, Target{Target::kBpvf, 2.0}}) {
    EncoderSettings settings = rig_settings(32);
    settings.target = target;
    EXPECT_EQ(decode_with_hashes(stream_by_frames(source, settings, 32)).size(), 96U);
  }
}

// Encodes with as little memory as encode() accepts.
class LittleMemory : public testing::Test {
 protected:
  static EncoderSettings settings(std::uint32_t threads) {
    EncoderSettings settings = rig_settings(100, threads);
    settings.max_memory_bytes = std::uint64_t{40} << 20;
    return settings;
  }
  MemoryFrames source_ = moving_tube(600, changing(500.0));
};

TEST_F(LittleMemory, LaterSpansUseTheRig) {
  EncodeReport report;
  const StreamBytes bytes = encode_to_memory(source_, settings(1), &report);
  ASSERT_FALSE(bytes.empty());
  EXPECT_TRUE(report.target_met);
  EXPECT_LE(report.metrics.kg_error_percent, 0.3);
  EXPECT_EQ(count(bytes, UnitType::kRig), 1U);
  EXPECT_GT(count(bytes, UnitType::kGof), 2U);
  EXPECT_EQ(decode_with_hashes(bytes).size(), 600U);
  EXPECT_EQ(bytes, encode_to_memory(source_, settings(2)));
}

}  // namespace
}  // namespace rlpc
