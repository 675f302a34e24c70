#include "encoder/codec/spans/split_coder.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

constexpr std::uint32_t kVertices = 2;

struct CoderCalls {
  int encodings = 0;
  int released = 0;
  int keeps = 0;
  std::vector<std::size_t> sizes;  // number of values in the frames, at each encoding
};

// Decodes to the frames, rounded, after a unit with the number of its first frame.
class CopyingCoder : public SpanCoder {
 public:
  CopyingCoder(const SpanFrames& frames, bool reads, CoderCalls& calls)
      : frames_(frames), reads_(reads), calls_(calls) {}
  bool needs_frames(double step, double /*analysis_step*/) const override {
    return reads_ || step > 5;
  }
  EncodedSpan encode(double step, double /*analysis_step*/) override {
    ++calls_.encodings;
    calls_.sizes.push_back(frames_.xyz.size());
    EncodedSpan encoded;
    if (!frames_.xyz.empty()) copy_ = frames_;
    encoded.units.push_back(
        {UnitType::kGof, {static_cast<std::uint8_t>(copy_.first_frame), 7}});
    encoded.units.push_back({UnitType::kSlice, {static_cast<std::uint8_t>(step)}});
    encoded.frame = [copy = copy_](std::uint32_t f, std::span<std::int32_t> positions) {
      for (std::uint32_t i = 0; i < 3 * kVertices; ++i) {
        positions[i] = static_cast<std::int32_t>(copy.at(f, 0)[i]);
      }
    };
    encoded.num_factors = 10 * copy_.num_frames;
    encoded.adaptive_values = 100 - copy_.first_frame;
    encoded.clusters = encoded.max_clusters = copy_.num_frames;
    encoded.components = 3;
    encoded.max_components = 1 + copy_.first_frame;
    return encoded;
  }
  void release_analysis() override { ++calls_.released; }
  void keep_num_components() override { ++calls_.keeps; }

 private:
  const SpanFrames& frames_;
  SpanFrames copy_;
  bool reads_;
  CoderCalls& calls_;
};

SpanFrames frames_of(std::uint32_t num_frames, std::uint32_t num_gofs) {
  SpanFrames frames{kVertices, num_frames, {}, 40, num_gofs};
  for (std::uint32_t i = 0; i < 3 * kVertices * num_frames; ++i) frames.xyz.push_back(i);
  return frames;
}

SplitCoder::MakeCoder copying(CoderCalls& calls, bool reads = true) {
  return [&calls, reads](const SpanFrames& frames) {
    return std::make_unique<CopyingCoder>(frames, reads, calls);
  };
}

TEST(SplitCoder, EncodesEachGofByItself) {
  const SpanFrames frames = frames_of(8, 3);
  CoderCalls calls;
  SplitCoder coder(frames, copying(calls));
  const EncodedSpan all = coder.encode(2, 2);
  ASSERT_EQ(all.units.size(), 6U);
  std::vector<std::uint8_t> firsts;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(all.units[i].type, i % 2 == 0 ? UnitType::kGof : UnitType::kSlice);
    if (i % 2 == 0) firsts.push_back(all.units[i].payload[0]);
  }
  EXPECT_EQ(firsts, (std::vector<std::uint8_t>{40, 42, 45}));
  // Each coder sees the frames of its GOF alone.
  EXPECT_EQ(calls.sizes, (std::vector<std::size_t>{12, 18, 18}));
}

TEST(SplitCoder, DecodesEachFrameByItsGof) {
  const SpanFrames frames = frames_of(8, 3);
  CoderCalls calls;
  SplitCoder coder(frames, copying(calls));
  const EncodedSpan all = coder.encode(2, 2);
  std::vector<std::int32_t> positions(3 * kVertices);
  for (const std::uint32_t f : {0U, 1U, 2U, 4U, 5U, 7U, 3U, 6U}) {
    all.frame(f, positions);
    for (std::uint32_t i = 0; i < 3 * kVertices; ++i) {
      EXPECT_EQ(positions[i], static_cast<std::int32_t>(6 * f + i));
    }
  }
}

TEST(SplitCoder, AddsUpAndTakesTheLargest) {
  const SpanFrames frames = frames_of(8, 3);
  CoderCalls calls;
  SplitCoder coder(frames, copying(calls));
  const EncodedSpan all = coder.encode(2, 2);
  EXPECT_EQ(all.num_factors, 30U);
  EXPECT_EQ(all.adaptive_values, 60U);
  EXPECT_EQ(all.clusters, 8U);
  EXPECT_EQ(all.max_clusters, 3U);
  EXPECT_EQ(all.components, 9U);
  EXPECT_EQ(all.max_components, 46U);
}

TEST(SplitCoder, ReadsFramesOnlyWhereACoderDoes) {
  const SpanFrames frames = frames_of(8, 2);
  CoderCalls calls;
  SplitCoder coder(frames, copying(calls, false));
  EXPECT_FALSE(coder.needs_frames(2, 2));
  EXPECT_TRUE(coder.needs_frames(6, 6));
  (void)coder.encode(6, 6);
  (void)coder.encode(2, 2);
  EXPECT_EQ(calls.sizes, (std::vector<std::size_t>{24, 24, 0, 0}));
}

TEST(SplitCoder, ReleasesTheAnalysisOfAll) {
  const SpanFrames frames = frames_of(8, 4);
  CoderCalls calls;
  SplitCoder coder(frames, copying(calls));
  coder.release_analysis();
  EXPECT_EQ(calls.released, 4);
}

TEST(SplitCoder, KeepsTheNumberOfComponentsOfAll) {
  const SpanFrames frames = frames_of(8, 4);
  CoderCalls calls;
  SplitCoder coder(frames, copying(calls));
  coder.keep_num_components();
  EXPECT_EQ(calls.keeps, 4);
}

}  // namespace
}  // namespace rlpc
