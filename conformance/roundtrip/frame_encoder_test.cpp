// Tests frames that arrive one by one: the stream, the target of each GOF, and refused frames.
#include "encoder/frame_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "conformance/testing/frame_by_frame.h"
#include "conformance/testing/small_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

// Errors of the decoded frames, GOF by GOF and as a whole.
struct Measured {
  std::vector<Metrics> gofs;
  Metrics whole;
};

Measured measure(FrameSource& source, const Encoded& encoded, std::uint32_t gof_frames) {
  auto decoder = Decoder::open(memory_source(encoded.bytes));
  EXPECT_TRUE(decoder);
  const std::size_t n = source.num_vertices();
  std::vector<std::int32_t> positions(3 * n);
  std::vector<float> decoded(3 * n);
  MetricsAccumulator whole(source.num_vertices());
  Measured measured;
  for (std::uint32_t first = 0; first < source.num_frames(); first += gof_frames) {
    MetricsAccumulator gof(source.num_vertices());
    for (std::uint32_t f = first; f < std::min(first + gof_frames, source.num_frames()); ++f) {
      EXPECT_TRUE(*decoder->next_frame(positions));
      for (std::size_t i = 0; i < 3 * n; ++i) {
        decoded[3 * encoded.report.input_vertex[i / 3] + i % 3] =
            float_position(decoder->header().grid, i % 3, positions[i]);
      }
      const auto original = frame_of(source, f);
      gof.add_frame(original, decoded);
      whole.add_frame(original, decoded);
    }
    measured.gofs.push_back(gof.result());
  }
  EXPECT_FALSE(*decoder->next_frame(positions));
  measured.whole = whole.result();
  return measured;
}

EncoderSettings fast_settings(Profile profile, Target target, std::uint32_t gof_frames) {
  EncoderSettings settings;
  settings.profile = profile;
  settings.preset = Preset::kFast;
  settings.target = target;
  settings.gof_frames = gof_frames;
  return settings;
}

class EachProfile : public testing::TestWithParam<Profile> {};
INSTANTIATE_TEST_SUITE_P(FrameEncoder, EachProfile,
                         testing::Values(Profile::kBaseline, Profile::kMain, Profile::kHigh));

// With fewer vertices, the error jumps by more than 2 % from step to step.
TEST_P(EachProfile, EveryGofMeetsTheKgError) {
  MemoryFrames source = bending_tube(80, 60);
  const auto encoded = encode_frames(source, fast_settings(GetParam(), {Target::kKg, 0.5}, 20));
  EXPECT_TRUE(encoded.report.target_met);
  EXPECT_EQ(encoded.report.num_gofs, 3U);
  const Measured measured = measure(source, encoded, 20);
  for (const Metrics& gof : measured.gofs) {
    EXPECT_LE(gof.kg_error_percent, 0.5);
    EXPECT_GE(gof.kg_error_percent, (GetParam() == Profile::kHigh ? 0.96 : 0.98) * 0.5);
  }
  EXPECT_LE(measured.whole.kg_error_percent, 0.5);
}

TEST_P(EachProfile, EveryGofMeetsTheLargestError) {
  MemoryFrames source = bending_tube(80, 60);
  const auto encoded =
      encode_frames(source, fast_settings(GetParam(), {Target::kMaxError, 0.01}, 20));
  EXPECT_TRUE(encoded.report.target_met);
  for (const Metrics& gof : measure(source, encoded, 20).gofs) EXPECT_LE(gof.max_error, 0.01);
}

TEST_P(EachProfile, TheWholeStreamMeetsTheRate) {
  MemoryFrames source = bending_tube(20, 200);
  const auto encoded =
      encode_frames(source, fast_settings(GetParam(), {Target::kBpvf, 6.0}, 10));
  EXPECT_TRUE(encoded.report.target_met);
  const double bpvf = bits_per_vertex_per_frame(encoded.bytes.size(), 100, 200);
  EXPECT_EQ(encoded.report.bpvf, bpvf);
  EXPECT_LE(bpvf, 6.0);
  EXPECT_GE(bpvf, 0.97 * 6.0);  // 2 % of each GOF, and the estimate of the index
}

TEST_P(EachProfile, ReportsTheMetricsOfTheStream) {
  MemoryFrames source = bending_tube(8, 30);
  const auto encoded = encode_frames(source, fast_settings(GetParam(), {Target::kKg, 1.0}, 10));
  const Metrics whole = measure(source, encoded, 10).whole;
  const Metrics& reported = encoded.report.metrics;
  EXPECT_EQ(reported.kg_error_percent, whole.kg_error_percent);
  EXPECT_EQ(reported.max_error, whole.max_error);
  EXPECT_EQ(reported.max_error_frame, whole.max_error_frame);
  EXPECT_EQ(reported.max_displacement, whole.max_displacement);
  EXPECT_EQ(reported.ramanathan_psnr_db, whole.ramanathan_psnr_db);
  EXPECT_TRUE(reported.frames.empty());
  EXPECT_EQ(encoded.report.bytes, encoded.bytes.size());
}

// Holds if the grid does not depend on later frames, and there is only one GOF.
TEST_P(EachProfile, OneGofIsCodedAsByEncode) {
  MemoryFrames source = bending_tube(8, 20);
  EncoderSettings settings =
      fast_settings(GetParam(), {Target::kMaxError, 0.01}, EncoderSettings::kWholeSequence);
  settings.preset = Preset::kMedium;
  settings.keep_order = true;
  settings.hash_mode = HashMode::kFrame;
  settings.metadata = R"({"title":"tube"})";
  EXPECT_EQ(encode_frames(source, settings).bytes, encode_to_memory(source, settings));
}

// A span that holds the whole sequence is coded as by encode(), too.
TEST(FrameEncoder, OneSpanIsCodedAsByEncode) {
  MemoryFrames source = bending_tube(8, 30);
  const EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kMaxError, 0.01}, 10);
  EXPECT_EQ(encode_frames(source, settings, 0).bytes, encode_to_memory(source, settings));
}

// Errors end at different distances from the target, which matters less over several targets.
TEST(FrameEncoder, GofsOfASpanShareASharedRig) {
  MemoryFrames source = bending_tube(80, 60);
  std::size_t bytes_apart = 0;
  std::size_t bytes_in_two = 0;
  std::size_t bytes_together = 0;
  for (const double kg : {0.2, 0.3, 0.5, 0.8}) {
    const EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kKg, kg}, 10);
    const Encoded apart = encode_frames(source, settings, 1);
    const Encoded in_two = encode_frames(source, settings, 30);
    const Encoded together = encode_frames(source, settings, 0);
    EXPECT_EQ(apart.report.num_gofs, 6U);
    EXPECT_EQ(in_two.report.num_gofs, 6U);
    EXPECT_EQ(together.report.num_gofs, 6U);
    bytes_apart += apart.bytes.size();
    bytes_in_two += in_two.bytes.size();
    bytes_together += together.bytes.size();
    EXPECT_LT(in_two.bytes.size(), apart.bytes.size());
    EXPECT_LE(measure(source, in_two, 10).whole.kg_error_percent, kg);
  }
  EXPECT_LT(bytes_in_two, bytes_apart);
  EXPECT_LT(bytes_together, bytes_in_two);
}

TEST(FrameEncoder, GivesTheBytesOfASpanWhenItIsFull) {
  MemoryFrames source = bending_tube(80, 60);
  FrameFormat format = format_of(source);
  format.max_held_frames = 30;
  std::size_t bytes = 0;
  auto encoder = FrameEncoder::create(
      format, fast_settings(Profile::kHigh, {Target::kKg, 1.0}, 10), [&](auto more) {
        bytes += more.size();
        return true;
      });
  ASSERT_TRUE(encoder);
  for (std::uint32_t f = 0; f < 60; ++f) {
    const std::size_t before = bytes;
    ASSERT_FALSE(encoder->add_frame(frame_of(source, f)));
    EXPECT_EQ(bytes > before, f % 30 == 29) << f;
  }
  EXPECT_TRUE(encoder->finish());
}

// Encodes the frames of a source as if their number were not known.
Encoded encode_open_ended(FrameSource& source, const EncoderSettings& settings) {
  Encoded out;
  FrameFormat format = format_of(source);
  format.num_frames = 0;
  format.max_held_frames = 1;
  auto encoder = FrameEncoder::create(format, settings, [&](auto more) {
    out.bytes.insert(out.bytes.end(), more.begin(), more.end());
    return true;
  });
  if (!encoder) throw std::logic_error(encoder.error().message);
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    const std::size_t before = out.bytes.size();
    if (const auto error = encoder->add_frame(frame_of(source, f))) {
      throw std::logic_error(error->message);
    }
    EXPECT_EQ(out.bytes.size() > before, settings.low_delay || f % 20 == 19) << f;
  }
  auto report = encoder->finish();
  if (!report) throw std::logic_error(report.error().message);
  out.report = std::move(*report);
  require_conforming(out.bytes);
  return out;
}

// GOFs may be of any kind; the last is shorter.
TEST(FrameEncoder, WithoutANumberOfFrames) {
  MemoryFrames source = bending_tube(80, 50);
  for (const std::optional<GofKind> kind :
       {std::optional<GofKind>(), std::optional(GofKind::kCluster),
        std::optional(GofKind::kInter)}) {
    EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kKg, 0.5}, 20);
    settings.gof_kind = kind;
    const auto encoded = encode_open_ended(source, settings);
    EXPECT_TRUE(encoded.report.target_met);
    EXPECT_EQ(encoded.report.num_gofs, 3U);
    EXPECT_EQ(encoded.report.header.num_frames, 50U);
    EXPECT_EQ(encoded.report.bpvf, bits_per_vertex_per_frame(encoded.bytes.size(), 400, 50));
    EXPECT_LE(measure(source, encoded, 20).whole.kg_error_percent, 0.5);
  }
}

TEST(FrameEncoder, WithLowDelayAFrameIsOutWhenItIsIn) {
  MemoryFrames source = bending_tube(80, 50);
  for (const Target& target : {Target{Target::kKg, 0.5}, Target{Target::kMaxError, 0.01},
                               Target{Target::kLossless, 11}}) {
    EncoderSettings settings = fast_settings(Profile::kHigh, target, 20);
    settings.low_delay = true;
    const auto encoded = encode_open_ended(source, settings);
    EXPECT_EQ(encoded.report.num_gofs, 3U);
    const Measured measured = measure(source, encoded, 20);
    EXPECT_EQ(encoded.report.metrics.max_error, measured.whole.max_error);
    if (target.kind == Target::kKg) {
      EXPECT_NEAR(measured.whole.kg_error_percent, 0.5, 0.15);
    } else {
      EXPECT_TRUE(encoded.report.target_met);
    }
  }
}

// GOFs have equal length if the number of frames is known; otherwise there is one.
TEST(FrameEncoder, WithLowDelayAndANumberOfFrames) {
  MemoryFrames source = bending_tube(80, 50);
  for (const std::uint32_t gof_frames : {20U, EncoderSettings::kWholeSequence}) {
    EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kKg, 0.5}, gof_frames);
    settings.low_delay = true;
    const auto encoded = encode_frames(source, settings);
    EXPECT_EQ(encoded.report.num_gofs, gof_frames == 20U ? 3U : 1U);
    EXPECT_EQ(encoded.report.header.num_frames, 50U);
    require_conforming(encoded.bytes);
  }
}

TEST(FrameEncoder, WithLowDelayAPoseThatIsHeldTakesAFewBytes) {
  MemoryFrames source = bending_tube(80, 2);
  FrameFormat format = format_of(source);
  format.num_frames = 0;
  EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kKg, 0.5}, 20);
  settings.low_delay = true;
  StreamBytes bytes;
  auto encoder = FrameEncoder::create(format, settings, [&](auto more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  });
  ASSERT_TRUE(encoder);
  ASSERT_FALSE(encoder->add_frame(frame_of(source, 0)));
  ASSERT_FALSE(encoder->add_frame(frame_of(source, 1)));
  const std::size_t before = bytes.size();
  for (int i = 0; i < 3; ++i) ASSERT_FALSE(encoder->add_frame(frame_of(source, 1)));
  EXPECT_LE(bytes.size(), before + 3 * 16);
  ASSERT_TRUE(encoder->finish());
  require_conforming(bytes);
}

TEST(FrameEncoder, WithoutAFrameThereIsNoStream) {
  MemoryFrames source = bending_tube(8, 4);
  FrameFormat format = format_of(source);
  format.num_frames = 0;
  for (const bool low_delay : {false, true}) {
    EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kKg, 0.5}, 20);
    settings.low_delay = low_delay;
    auto encoder = FrameEncoder::create(format, settings, discard);
    ASSERT_TRUE(encoder);
    const auto report = encoder->finish();
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("at least one frame"), std::string::npos);
  }
}

// A wrong frame is left out; the others make a stream.
TEST(FrameEncoder, WithLowDelayAWrongFrameIsNoEnd) {
  MemoryFrames source = bending_tube(8, 4);
  FrameFormat format = format_of(source);
  format.num_frames = 0;
  EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kLossless, 12}, 20);
  settings.low_delay = true;
  StreamBytes bytes;
  auto encoder = FrameEncoder::create(format, settings, [&](auto more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  });
  ASSERT_TRUE(encoder);
  ASSERT_FALSE(encoder->add_frame(frame_of(source, 0)));
  std::vector<float> wrong = frame_of(source, 1);
  wrong[5] = std::numeric_limits<float>::quiet_NaN();
  const auto error = encoder->add_frame(wrong);
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("frame 1 (from 0), vertex 1: z is nan"), std::string::npos);
  wrong.pop_back();
  EXPECT_TRUE(encoder->add_frame(wrong));
  ASSERT_FALSE(encoder->add_frame(frame_of(source, 1)));
  const auto report = encoder->finish();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->header.num_frames, 2U);
  require_conforming(bytes);
}

TEST(FrameEncoder, QuantisersOfThePaperNeedNoSearch) {
  MemoryFrames source = bending_tube(6, 12);
  EncoderSettings settings = rich_settings();
  const auto encoded = encode_frames(source, settings);
  EXPECT_EQ(encoded.report.trials, 4U);
  EXPECT_EQ(encoded.report.step, 0.0);
}

TEST(FrameEncoder, LosslessOnAGridOfBits) {
  MemoryFrames source = bending_tube(8, 30);
  const EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kLossless, 12}, 10);
  const auto encoded = encode_frames(source, settings);
  EXPECT_EQ(encoded.report.trials, 3U);  // one for each span
  EXPECT_TRUE(encoded.report.target_met);
  const SequenceHeader& header = encoded.report.header;
  EXPECT_LE(header.position_bits, 12);
  const double largest = std::sqrt(3.0) * 0.5 * std::ldexp(1.0, header.grid.log2_step);
  EXPECT_GT(encoded.report.metrics.max_error, 0.2 * largest);
  EXPECT_LE(encoded.report.metrics.max_error, (1.0 + 1e-6) * largest);
}

TEST(FrameEncoder, CannotKnowTheGridOfFramesToCome) {
  MemoryFrames source = bending_tube(8, 30);
  const EncoderSettings settings = fast_settings(Profile::kHigh, {Target::kLossless, 0}, 10);
  const auto encoder = FrameEncoder::create(format_of(source), settings, discard);
  ASSERT_FALSE(encoder);
  EXPECT_NE(encoder.error().message.find("needs a number of bits"), std::string::npos);
}

TEST(FrameEncoder, GivesTheBytesOfAGofWhenItIsFull) {
  MemoryFrames source = bending_tube(8, 30);
  std::size_t bytes = 0;
  auto encoder = FrameEncoder::create(
      format_of(source), fast_settings(Profile::kMain, {Target::kKg, 1.0}, 10), [&](auto more) {
        bytes += more.size();
        return true;
      });
  ASSERT_TRUE(encoder);
  for (std::uint32_t f = 0; f < 30; ++f) {
    const std::size_t before = bytes;
    ASSERT_FALSE(encoder->add_frame(frame_of(source, f)));
    EXPECT_EQ(bytes > before, f % 10 == 9) << f;
    EXPECT_EQ(encoder->num_added(), f + 1);
  }
}

std::string error_of_format(const std::function<void(FrameFormat&)>& change,
                            const EncoderSettings& settings = {}) {
  MemoryFrames source = bending_tube(4, 4);
  FrameFormat format = format_of(source);
  change(format);
  const auto encoder = FrameEncoder::create(format, settings, discard);
  return encoder ? "" : encoder.error().message;
}

TEST(FrameEncoder, RefusesFormatsThatCannotBe) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  EXPECT_EQ(error_of_format([](auto&) {}), "");
  expect(error_of_format([](auto& f) { f.num_vertices = 0; }), "at least one vertex");
  expect(error_of_format([](auto& f) { f.num_vertices = 19; }), "vertex 19 of 19");
  expect(error_of_format([](auto& f) { f.num_vertices = 1U << 24; }), "no level allows");
  expect(error_of_format([](auto& f) { f.num_frames = 0; }), "only the High profile");
  expect(error_of_format([](auto& f) { f.num_frames = kMaxFrames + 1; }), "not 16777217");
  expect(error_of_format([](auto& f) { f.frame_rate.denominator = 0; }), "frame rate");
  const std::string levels = std::to_string(kMaxLevelIdc);
  expect(error_of_format([](auto& f) { f.least_level = kMaxLevelIdc + 1; }), "1 to " + levels);
  expect(error_of_format([](auto& f) { f.box_min[1] = f.box_max[1] + 1; }), "extent in y");
  expect(error_of_format([&](auto& f) { f.box_max[2] = nan; }), "extent in z");
  expect(error_of_format([](auto& f) { f.box_max[0] = 1e37F; }), "extent in x");
  EncoderSettings bad;
  bad.target.value = 0.0;
  expect(error_of_format([](auto&) {}, bad), "above zero");
}

TEST(FrameEncoder, NamesFrameVertexAndAxisOutsideTheBox) {
  MemoryFrames source = bending_tube(4, 4);
  for (const float wrong : {50.0F, std::numeric_limits<float>::quiet_NaN()}) {
    auto encoder = FrameEncoder::create(format_of(source), {}, discard);
    ASSERT_TRUE(encoder);
    ASSERT_FALSE(encoder->add_frame(frame_of(source, 0)));
    auto frame = frame_of(source, 1);
    frame[3 * 7 + 1] = wrong;
    const auto error = encoder->add_frame(frame);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->message.find("frame 1 (from 0), vertex 7: y is "), 0U) << error->message;
    // The error is sticky.
    EXPECT_EQ(encoder->add_frame(frame_of(source, 1))->message, error->message);
    EXPECT_EQ(encoder->finish().error().message, error->message);
  }
}

TEST(FrameEncoder, TakesAsManyFramesAndValuesAsAnnounced) {
  MemoryFrames source = bending_tube(4, 2);
  const auto begin = [&] {
    return std::move(*FrameEncoder::create(format_of(source), {}, discard));
  };
  const auto frame = frame_of(source, 0);

  FrameEncoder wrong = begin();
  EXPECT_EQ(wrong.add_frame(std::span(frame).first(59))->message,
            "frame 0 (from 0) has 59 values; 20 vertices have 60");

  FrameEncoder fewer = begin();
  ASSERT_FALSE(fewer.add_frame(frame));
  EXPECT_EQ(fewer.finish().error().message, "the stream ends after 1 of 2 frames announced");

  FrameEncoder more = begin();
  ASSERT_FALSE(more.add_frame(frame));
  ASSERT_FALSE(more.add_frame(frame));
  EXPECT_NE(more.add_frame(frame)->message.find("one more than"), std::string::npos);

  FrameEncoder twice = begin();
  ASSERT_FALSE(twice.add_frame(frame));
  ASSERT_FALSE(twice.add_frame(frame));
  EXPECT_TRUE(twice.finish());
  EXPECT_EQ(twice.finish().error().message, "the stream is finished already");
}

TEST(FrameEncoder, ASinkThatFailsEndsIt) {
  MemoryFrames source = bending_tube(4, 8);
  const auto settings = fast_settings(Profile::kMain, {Target::kKg, 5.0}, 4);
  for (int allowed = 0;; ++allowed) {
    int calls = 0;
    auto encoder = FrameEncoder::create(format_of(source), settings,
                                        [&](auto) { return calls++ < allowed; });
    ASSERT_TRUE(encoder);
    std::string message;
    for (std::uint32_t f = 0; f < 8 && message.empty(); ++f) {
      if (const auto error = encoder->add_frame(frame_of(source, f))) message = error->message;
    }
    const auto report = encoder->finish();
    if (report) {
      EXPECT_GT(allowed, 5);
      return;
    }
    EXPECT_EQ(report.error().message, "the stream could not be written");
    EXPECT_EQ(calls, allowed + 1);
  }
}

// The first frames are still, and give no hint of the noise that follows.
TEST(FrameEncoder, ALaterGofThatNeedsAHigherLevelIsAnError) {
  constexpr std::uint32_t kVertices = 520;  // more components than level 1 has
  constexpr std::uint32_t kGofFrames = 176;
  const auto encode_noise = [](std::uint32_t least_level) {
    FrameFormat format;
    format.num_vertices = kVertices;
    format.num_frames = 2 * kGofFrames;
    format.box_max = {1, 1, 1};
    format.least_level = least_level;
    EncoderSettings settings = fast_settings(Profile::kMain, {Target::kNone, 0.0}, kGofFrames);
    settings.gof_kind = GofKind::kSkinned;
    auto encoder = FrameEncoder::create(format, settings, discard);
    std::vector<float> xyz(3 * kVertices);
    std::uint32_t random = 1;
    for (std::uint32_t f = 0; f < format.num_frames; ++f) {
      for (float& x : xyz) {
        random = random * 1664525 + 1013904223;
        x = f < kGofFrames ? 0.5F : static_cast<float>(random >> 8) / 0x1p24F;
      }
      if (const auto error = encoder->add_frame(xyz)) return error->message;
    }
    return std::string();
  };
  EXPECT_EQ(encode_noise(1),
            "frames 176 to 351 need level 2 (specification, Annex B), but the stream has "
            "level 1: encode again with a higher least level, or with fewer components");
  EXPECT_EQ(encode_noise(2), "");
}

}  // namespace
}  // namespace rlpc
