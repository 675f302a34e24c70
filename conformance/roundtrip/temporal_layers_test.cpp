// Tests streams with temporal layers, from encoder to extractor and decoder: cuts have the size
// and error that the encoder reports.
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "common/files/float_position.h"
#include "conformance/testing/cut_streams.h"
#include "conformance/testing/frame_by_frame.h"
#include "conformance/testing/small_animation.h"
#include "conformance/testing/stream_summary.h"
#include "decoder/codec/units/stream_summary.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kLayeredFrames = 60;

EncoderSettings settings_with(std::uint32_t layers, std::uint32_t gof_frames) {
  EncoderSettings settings;
  settings.profile = Profile::kHigh;
  settings.preset = Preset::kFast;
  settings.target = {Target::kKg, 0.3};
  settings.gof_frames = gof_frames;
  settings.keep_order = true;
  settings.main.temporal_layers = layers;
  return settings;
}

Encoded encoded_layers(const EncoderSettings& settings) {
  MemoryFrames source = bending_tube(16, kLayeredFrames);
  return encode_with_report(source, settings);
}

Encoded encoded_by_frames(const EncoderSettings& settings) {
  MemoryFrames source = bending_tube(16, kLayeredFrames);
  return encode_frames(source, settings);
}

// Returns the KG error of a stream in the order of the input.
double kg_error(const StreamBytes& stream) {
  MemoryFrames source = bending_tube(16, kLayeredFrames);
  auto decoder = Decoder::open(memory_source(stream));
  EXPECT_TRUE(decoder);
  MetricsAccumulator metrics(source.num_vertices());
  std::vector<float> original(3 * std::size_t{source.num_vertices()});
  std::vector<std::int32_t> positions(original.size());
  std::vector<float> decoded(original.size());
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    EXPECT_FALSE(source.read_frame(f, original));
    EXPECT_TRUE(decoder->next_frame(positions));
    for (std::size_t i = 0; i < positions.size(); ++i) {
      decoded[i] = float_position(decoder->header().grid, i % 3, positions[i]);
    }
    metrics.add_frame(original, decoded);
  }
  return metrics.result().kg_error_percent;
}

void expect_reported_cuts(const Encoded& whole, std::uint32_t layers) {
  ASSERT_EQ(whole.report.temporal_cuts.size(), layers - 1);
  const SliceCut all;
  double finer = whole.report.metrics.kg_error_percent;
  std::uint64_t more = whole.bytes.size();
  for (std::uint32_t left = layers - 1; left > 0; --left) {
    SCOPED_TRACE(left);
    const TemporalCut& reported = whole.report.temporal_cuts[left - 1];
    EXPECT_EQ(reported.layers, left);
    const SliceCut cut{all.max_components, all.max_layers, left};
    const StreamBytes out = cut_stream(whole.bytes, cut);
    require_conforming(out);
    EXPECT_EQ(out.size(), reported.bytes);
    EXPECT_NEAR(kg_error(out), reported.kg_error_percent, 1e-9);
    EXPECT_LT(reported.bytes, more);
    EXPECT_GT(reported.kg_error_percent, finer);
    more = reported.bytes;
    finer = reported.kg_error_percent;
    DecoderOptions options;
    options.cut = cut;
    EXPECT_EQ(decode_all(out), decode_all(whole.bytes, options));
    EXPECT_EQ(decode_all(out).size(), kLayeredFrames);
  }
}

TEST(TemporalLayers, CutsAreAsReported) {
  for (const std::uint32_t layers : {2U, 3U}) {
    SCOPED_TRACE(layers);
    const Encoded whole =
        encoded_layers(settings_with(layers, EncoderSettings::kWholeSequence));
    EXPECT_TRUE(whole.report.target_met);
    expect_reported_cuts(whole, layers);
  }
}

TEST(TemporalLayers, CutsOfGofsThatShareARigAreAsReported) {
  const Encoded whole = encoded_layers(settings_with(2, 15));
  EXPECT_FALSE(summary_of(whole.bytes).rigs.empty());
  expect_reported_cuts(whole, 2);
}

// The stream has an index, whose offsets change.
TEST(TemporalLayers, CutsOfManyGofsAreAsReported) {
  const Encoded whole = encoded_layers(settings_with(2, 3));
  EXPECT_EQ(whole.report.num_gofs, 20U);
  expect_reported_cuts(whole, 2);
}

TEST(TemporalLayers, CutsOfFramesThatComeOneByOneAreAsReported) {
  expect_reported_cuts(encoded_by_frames(settings_with(3, 20)), 3);
}

TEST(TemporalLayers, AreOffByDefault) {
  const Encoded plain = encoded_layers(settings_with(1, 20));
  EXPECT_TRUE(plain.report.temporal_cuts.empty());
  for (const GofSummary& gof : summary_of(plain.bytes).gofs) {
    EXPECT_EQ(gof.num_temporal_layers(), 1U);
    EXPECT_EQ(gof.figure("num_temporal_layers"), 1U);
  }
}

TEST(TemporalLayers, AreInEveryGof) {
  const Encoded whole = encoded_layers(settings_with(3, 20));
  for (const GofSummary& gof : summary_of(whole.bytes).gofs) {
    EXPECT_EQ(gof.num_temporal_layers(), 3U);
    EXPECT_EQ(gof.figure("num_temporal_layers"), 3U);
  }
}

TEST(TemporalLayers, DoNotDependOnThreads) {
  EncoderSettings settings = settings_with(2, 15);
  const Encoded one = encoded_layers(settings);
  settings.threads = 3;
  const Encoded three = encoded_layers(settings);
  EXPECT_EQ(one.bytes, three.bytes);
  EXPECT_EQ(one.report.temporal_cuts[0].bytes, three.report.temporal_cuts[0].bytes);
  EXPECT_EQ(one.report.temporal_cuts[0].kg_error_percent,
            three.report.temporal_cuts[0].kg_error_percent);
}

}  // namespace
}  // namespace rlpc
