#include "encoder/codec/sequence/span_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/parallel/for_each.h"
#include "encoder/codec/sequence/choices/grid_choice.h"

namespace rlpc {
namespace {

// A waving strip of squares.
class WavingStrip final : public FrameSource {
 public:
  static constexpr std::uint32_t kColumns = 30;

  explicit WavingStrip(std::uint32_t num_frames)
      : FrameSource({2 * kColumns, num_frames, {}, squares()}) {}
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    ++reads;
    for (std::uint32_t v = 0; v < num_vertices(); ++v) {
      const double along = v >> 1;
      xyz[3 * v] = static_cast<float>(along);
      xyz[3 * v + 1] = static_cast<float>(v % 2);
      xyz[3 * v + 2] = static_cast<float>(4.0 * std::sin(0.4 * frame + 0.3 * along) +
                                          std::sin(0.9 * frame * along));
    }
    return std::nullopt;
  }

  int reads = 0;

 private:
  static std::vector<Triangle> squares() {
    std::vector<Triangle> list;
    for (std::uint32_t i = 0; i + 1 < kColumns; ++i) {
      list.push_back({2 * i, 2 * i + 2, 2 * i + 1});
      list.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
    }
    return list;
  }
};

SequenceHeader header_of(FrameSource& source, const EncoderSettings& settings) {
  SequenceHeader header;
  header.profile_idc = static_cast<std::uint32_t>(settings.profile);
  header.num_vertices = source.num_vertices();
  header.num_triangles = static_cast<std::uint32_t>(source.triangles().size());
  header.num_frames = source.num_frames();
  set_grid(header, choose_grid(*measure_extent(source), 0.0));
  return header;
}

// Keeping analyses from one step to the next only saves time.
TEST(SpanBatch, GivesAlmostTheSameBytesWithoutKeepingAnalyses) {
  for (const Profile profile : {Profile::kBaseline, Profile::kMain}) {
    EncoderSettings settings;
    settings.profile = profile;
    WavingStrip source(24);
    const SequenceCoding coding(header_of(source, settings), settings, source.triangles());
    const std::vector<FrameRange> spans{{0, 12}, {12, 12}};
    SpanBatch keeping(coding, source, spans, {.keep_analyses = true});
    SpanBatch releasing(coding, source, spans, {.keep_analyses = false});
    EXPECT_EQ(keeping.num_frames(), 24U);
    for (const double step : {900.0, 1000.0, 2500.0, 600.0}) {
      const double analysis_step = step == 1000.0 ? 900.0 : step;
      const auto kept = keeping.encode(step, analysis_step, {});
      const auto released = releasing.encode(step, analysis_step, {});
      ASSERT_TRUE(kept && released);
      EXPECT_NEAR(static_cast<double>(kept->gof_bytes),
                  static_cast<double>(released->gof_bytes),
                  0.02 * static_cast<double>(released->gof_bytes))
          << step;
      for (const SpanResult& gof : kept->spans) EXPECT_FALSE(gof.frame);
    }
    EXPECT_FALSE(releasing.expected_error());
  }
}

TEST(SpanBatch, EstimatesTheErrorOnceAllGofsAreAnalysed) {
  EncoderSettings settings;
  settings.preset = Preset::kFast;
  WavingStrip source(24);
  const SequenceCoding coding(header_of(source, settings), settings, source.triangles());
  SpanBatch both(coding, source, {{0, 12}, {12, 12}}, {});
  SpanBatch first(coding, source, {{0, 12}}, {});
  SpanBatch second(coding, source, {{12, 12}}, {});
  EXPECT_FALSE(both.expected_error());
  for (SpanBatch* batch : {&both, &first, &second}) ASSERT_FALSE(batch->analyse(1000.0));
  const auto sum = both.expected_error();
  ASSERT_TRUE(sum);
  EXPECT_GT(sum(1000.0), 0.0);
  EXPECT_DOUBLE_EQ(sum(1000.0),
                   first.expected_error()(1000.0) + second.expected_error()(1000.0));
}

// In a later batch, frame numbers continue from the previous one.
TEST(SpanBatch, NumbersFramesFromItsFirst) {
  EncoderSettings settings;
  settings.preset = Preset::kFast;
  WavingStrip source(8);
  const SequenceCoding coding(header_of(source, settings), settings, source.triangles());
  SpanBatch plain(coding, source, {{0, 8}}, {});
  SpanBatch later(coding, source, {{0, 8}}, {.first_frame = 6, .keep_decoded = true});
  const auto a = plain.encode(1000.0, 1000.0, {});
  const auto b = later.encode(1000.0, 1000.0, {});
  ASSERT_TRUE(a && b);
  EXPECT_NE(a->spans[0].gofs.front().units, b->spans[0].gofs.front().units);
  EXPECT_EQ(a->metrics.kg_error_percent, b->metrics.kg_error_percent);
  EXPECT_TRUE(b->spans[0].frame);
}

EncoderSettings high_settings() {
  EncoderSettings settings;
  settings.profile = Profile::kHigh;
  settings.preset = Preset::kFast;
  return settings;
}

// In the High profile, spans follow each other; how many are encoded at a time, and on how many
// threads, affects time and memory only.
TEST(SpanBatch, LaterSpansUseRigsOfEarlierOnes) {
  const EncoderSettings settings = high_settings();
  WavingStrip source(96);
  const SequenceCoding coding(header_of(source, settings), settings, source.triangles());
  const std::vector<FrameRange> spans{{0, 24}, {24, 24, 2}, {48, 24}, {72, 24}};
  std::vector<std::vector<std::uint8_t>> first;  // bytes of the spans, step by step
  for (const std::uint32_t together : {1U, 2U, 4U, 1U}) {
    const Threads threads(first.empty() ? 1 : 2);
    SpanBatch batch(coding, source, spans, {.together = together});
    EXPECT_FALSE(batch.uses_earlier_rigs());
    std::vector<std::vector<std::uint8_t>> bytes;
    for (const double step : {2000.0, 1800.0}) {
      const auto trial = batch.encode(step, step, {});
      ASSERT_TRUE(trial);
      EXPECT_TRUE(batch.uses_earlier_rigs());
      EXPECT_FALSE(trial->spans[0].gofs[0].rig.empty());
      EXPECT_EQ(trial->spans[1].gofs.size(), 2U);
      for (const SpanResult& span : trial->spans) {
        EXPECT_FALSE(span.rig);
        for (const GofBytes& gof : span.gofs) {
          bytes.push_back(gof.rig);
          bytes.push_back(gof.units);
        }
      }
    }
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << together;
    EXPECT_TRUE(batch.use_own_rigs());
    EXPECT_FALSE(batch.uses_earlier_rigs());
    EXPECT_FALSE(batch.use_own_rigs());
  }
}

// A batch can start from the rig of the one before.
TEST(SpanBatch, TakesTheRigInForce) {
  const EncoderSettings settings = high_settings();
  WavingStrip source(48);
  const SequenceCoding coding(header_of(source, settings), settings, source.triangles());
  SpanBatch before(coding, source, {{0, 24}}, {.keep_decoded = true, .has_followers = true});
  const auto first = before.encode(2000.0, 2000.0, {});
  ASSERT_TRUE(first);
  ASSERT_TRUE(first->spans[0].rig);
  SpanBatch after(coding, source, {{24, 24}},
                  {.keep_decoded = true, .rig = first->spans[0].rig});
  const auto second = after.encode(2000.0, 2000.0, {});
  ASSERT_TRUE(second);
  EXPECT_TRUE(after.uses_earlier_rigs());
  EXPECT_FALSE(second->spans[0].rig);
  SpanBatch alone(coding, source, {{24, 24}}, {});
  EXPECT_LT(second->gof_bytes, alone.encode(2000.0, 2000.0, {})->gof_bytes);
}

}  // namespace
}  // namespace rlpc
