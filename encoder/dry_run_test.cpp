#include "encoder/dry_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "encoder/rlpc_encoder.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kSide = 6;

// A waving sheet whose amplitude doubles halfway.
class Waves final : public FrameSource {
 public:
  explicit Waves(std::uint32_t num_frames)
      : FrameSource({kSide * kSide, num_frames, {}, mesh()}) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    last_ = std::max(last_, frame);
    const double height = frame < num_frames() / 2 ? 0.3 : 0.6;
    for (std::size_t v = 0; v < num_vertices(); ++v) {
      const std::size_t row = v / kSide;
      const auto x = static_cast<double>(v % kSide);
      const auto y = static_cast<double>(row);
      xyz[3 * v] = static_cast<float>(x);
      xyz[3 * v + 1] = static_cast<float>(y);
      xyz[3 * v + 2] = static_cast<float>(height * std::sin(0.9 * x + 0.21 * frame) +
                                          0.2 * std::sin(1.3 * y + 0.083 * frame));
    }
    return std::nullopt;
  }

  std::uint32_t last() const { return last_; }

 private:
  static std::vector<Triangle> mesh() {
    std::vector<Triangle> triangles;
    for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
      for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
        const std::uint32_t v = kSide * y + x;
        triangles.push_back({v, v + 1, v + kSide});
        triangles.push_back({v + 1, v + kSide + 1, v + kSide});
      }
    }
    return triangles;
  }

  std::uint32_t last_ = 0;
};

EncoderSettings fast() {
  EncoderSettings settings;
  settings.preset = Preset::kFast;
  settings.target = {Target::kKg, 0.3};
  return settings;
}

std::uint64_t encoded_bytes(FrameSource& source, const EncoderSettings& settings) {
  const auto report =
      encode(source, settings, [](std::span<const std::uint8_t>) { return true; });
  EXPECT_TRUE(report);
  return report ? report->bytes : 0;
}

TEST(DryRun, IsExactUpToEightStretches) {
  EncoderSettings settings = fast();
  settings.gof_frames = 50;  // longer sequences would have stretches of 100 frames
  Waves source(1024);
  const auto expected = expect_encoding(source, settings);
  ASSERT_TRUE(expected);
  EXPECT_TRUE(expected->exact());
  EXPECT_EQ(expected->frames_encoded, 1024U);
  EXPECT_EQ(expected->report.bytes, encoded_bytes(source, settings));
}

TEST(DryRun, ExtrapolatesLongerSequences) {
  EncoderSettings settings = fast();
  settings.gof_frames = 50;
  Waves source(2400);
  const auto expected = expect_encoding(source, settings);
  ASSERT_TRUE(expected);
  EXPECT_FALSE(expected->exact());
  EXPECT_EQ(expected->frames_encoded, 800U);
  EXPECT_EQ(expected->report.header.num_frames, 2400U);
  EXPECT_EQ(expected->report.num_gofs, 48U);
  EXPECT_GE(expected->report.clusters, 48U);  // at least one per GOF
  EXPECT_EQ(source.last(), 2399U);            // the last frame was read
  const double bytes = static_cast<double>(encoded_bytes(source, settings));
  EXPECT_NEAR(static_cast<double>(expected->report.bytes), bytes, 0.05 * bytes);
  EXPECT_DOUBLE_EQ(expected->report.bpvf,
                   8 * static_cast<double>(expected->report.bytes) / (36 * 2400));
}

// A GOF of the default length never covers two stretches.
TEST(DryRun, StretchesAreAsLongAsGofs) {
  EncoderSettings settings = fast();
  settings.profile = Profile::kHigh;
  settings.target = {Target::kKg, 5};
  Waves source(2100);
  const auto expected = expect_encoding(source, settings);
  ASSERT_TRUE(expected);
  EXPECT_FALSE(expected->exact());
  EXPECT_EQ(expected->frames_encoded, 2048U);
}

TEST(DryRun, EncodesASingleGofCompletely) {
  EncoderSettings settings = fast();
  settings.gof_frames = EncoderSettings::kWholeSequence;
  settings.target = {Target::kKg, 5};
  Waves source(1100);
  const auto expected = expect_encoding(source, settings);
  ASSERT_TRUE(expected);
  EXPECT_TRUE(expected->exact());
  EXPECT_EQ(expected->report.num_gofs, 1U);
}

}  // namespace
}  // namespace rlpc
