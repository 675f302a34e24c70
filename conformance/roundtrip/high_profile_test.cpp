// Tests streams of the High profile whose GOFs use shared rigs, from encoder to decoder.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "conformance/testing/small_animation.h"
#include "conformance/testing/stream_summary.h"
#include "decoder/codec/units/stream_summary.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

Encoded encoded_tube(Profile profile, Target target, std::uint32_t gof_frames,
                     Preset preset = Preset::kFast) {
  MemoryFrames source = bending_tube(16, 60);
  EncoderSettings settings;
  settings.profile = profile;
  settings.preset = preset;
  settings.target = target;
  settings.gof_frames = gof_frames;
  settings.hash_mode = HashMode::kFrame;  // hashes of the encoder's reconstruction
  return encode_with_report(source, settings);
}

TEST(HighProfile, GofsShareARig) {
  const Encoded high = encoded_tube(Profile::kHigh, {Target::kKg, 0.5}, 15);
  const Encoded main = encoded_tube(Profile::kMain, {Target::kKg, 0.5}, 15);
  EXPECT_TRUE(high.report.target_met);
  EXPECT_EQ(high.report.num_gofs, 4U);
  EXPECT_LT(high.bytes.size(), main.bytes.size() * 3 / 4);
  const StreamSummary summary = summary_of(high.bytes);
  ASSERT_EQ(summary.rigs.size(), 1U);
  EXPECT_EQ(summary.rigs[0]->num_gofs, 4U);
  for (const GofSummary& gof : summary.gofs) EXPECT_EQ(gof.num_frames, 15U);
}

TEST(HighProfile, ASingleGofNeedsNoRig) {
  for (const std::uint32_t frames : {60U, EncoderSettings::kWholeSequence}) {
    const Encoded high = encoded_tube(Profile::kHigh, {Target::kKg, 0.5}, frames);
    EXPECT_TRUE(summary_of(high.bytes).rigs.empty());
  }
}

TEST(HighProfile, MeetsItsTargets) {
  const Encoded error = encoded_tube(Profile::kHigh, {Target::kMaxError, 0.01}, 20);
  EXPECT_TRUE(error.report.target_met);
  EXPECT_LE(error.report.metrics.max_error, 0.01);
  const Encoded rate = encoded_tube(Profile::kHigh, {Target::kBpvf, 4.0}, 20);
  EXPECT_TRUE(rate.report.target_met);
  EXPECT_LE(rate.report.bpvf, 4.0);
  EXPECT_GE(rate.report.bpvf, 0.95 * 4.0);
  EXPECT_EQ(rate.bytes.size(), rate.report.bytes);
}

// Many GOFs get an index, which lists the rigs.
TEST(HighProfile, FramesAreFoundByTheIndex) {
  const Encoded high = encoded_tube(Profile::kHigh, {Target::kKg, 1.0}, 3);
  EXPECT_EQ(high.report.num_gofs, 20U);
  const auto units = units_of(high.bytes);
  EXPECT_EQ(std::count_if(units.begin(), units.end(),
                          [](const UnitPlace& u) { return u.type == UnitType::kGofIndex; }),
            1);
  auto in_order = Decoder::open(memory_source(high.bytes));
  auto seeking = Decoder::open(memory_source(high.bytes));
  ASSERT_TRUE(in_order && seeking);
  std::vector<std::vector<std::int32_t>> frames(60);
  for (auto& frame : frames) {
    frame.resize(3 * std::size_t{in_order->header().num_vertices});
    ASSERT_TRUE(in_order->next_frame(frame));
  }
  std::vector<std::int32_t> frame(frames[0].size());
  for (std::uint32_t f = 60; f-- > 0;) {
    ASSERT_TRUE(seeking->seek(f));
    ASSERT_TRUE(seeking->next_frame(frame));
    EXPECT_EQ(frame, frames[f]);
  }
}

TEST(HighProfile, EncodesTheSameEachTime) {
  for (const Preset preset : {Preset::kFast, Preset::kMedium}) {
    EXPECT_EQ(encoded_tube(Profile::kHigh, {Target::kKg, 0.5}, 20, preset).bytes,
              encoded_tube(Profile::kHigh, {Target::kKg, 0.5}, 20, preset).bytes);
  }
}

}  // namespace
}  // namespace rlpc
