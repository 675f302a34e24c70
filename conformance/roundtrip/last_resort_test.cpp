// Tests that cluster GOFs reach targets that skinned GOFs miss, in the Main profile.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "conformance/testing/small_animation.h"
#include "encoder/frame_encoder.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kStripFrames = 8;

// A trembling strip of triangles, with a vertex that is far away in one frame.
MemoryFrames strip_with_outlier(std::uint32_t num_vertices, float far_away) {
  FrameSource::Shape shape;
  for (std::uint32_t v = 0; v + 2 < num_vertices; ++v) {
    shape.triangles.push_back({v, v + 1, v + 2});
  }
  std::mt19937 random(num_vertices);
  const auto number = [&random] { return static_cast<float>(random() % 1000) / 1000.0F; };
  std::vector<float> rest(3 * std::size_t{num_vertices});
  for (float& x : rest) x = number();
  std::vector<std::vector<float>> frames;
  for (std::uint32_t f = 0; f < kStripFrames; ++f) {
    frames.push_back(rest);
    for (float& x : frames.back()) x += 0.1F * number();
  }
  frames[5][0] = far_away;
  return {std::move(shape), std::move(frames)};
}

struct OutlierCase {
  std::uint32_t num_vertices;
  float far_away;
  double max_error;
};
constexpr OutlierCase kCases[] = {
    {3, 10.0F, 3e-6}, {4, 1000.0F, 3e-4}, {20, 1000.0F, 1e-3}, {3, 1e5F, 0.03}};

EncoderSettings settings_of_case(const OutlierCase& c, Profile profile, Preset preset) {
  EncoderSettings settings;
  settings.profile = profile;
  settings.preset = preset;
  settings.target = {Target::kMaxError, c.max_error};
  return settings;
}

EncodeReport encode_case(const OutlierCase& c, const EncoderSettings& settings) {
  MemoryFrames source = strip_with_outlier(c.num_vertices, c.far_away);
  EncodeReport report;
  const StreamBytes stream = encode_to_memory(source, settings, &report);
  EXPECT_EQ(report.metrics.max_error <= c.max_error, report.target_met);
  return report;
}

class EachPreset : public testing::TestWithParam<Preset> {};
INSTANTIATE_TEST_SUITE_P(LastResort, EachPreset,
                         testing::Values(Preset::kFast, Preset::kMedium, Preset::kSlow));

TEST_P(EachPreset, MainReachesWhatBaselineReaches) {
  for (const OutlierCase& c : kCases) {
    SCOPED_TRACE(testing::Message() << c.num_vertices << " vertices, " << c.max_error);
    EXPECT_TRUE(encode_case(c, settings_of_case(c, Profile::kBaseline, GetParam())).target_met);
    EXPECT_TRUE(encode_case(c, settings_of_case(c, Profile::kMain, GetParam())).target_met);
  }
}

TEST_P(EachPreset, BonesThatAreAskedForStay) {
  int missed = 0;
  for (const OutlierCase& c : kCases) {
    EncoderSettings settings = settings_of_case(c, Profile::kMain, GetParam());
    settings.main.clusters = false;
    if (!encode_case(c, settings).target_met) ++missed;
  }
  EXPECT_GT(missed, 0) << "no case for a last resort";
}

TEST(LastResort, FramesThatComeOneByOneReachTheTarget) {
  for (const OutlierCase& c : kCases) {
    MemoryFrames source = strip_with_outlier(c.num_vertices, c.far_away);
    FrameFormat format;
    format.num_vertices = c.num_vertices;
    format.num_frames = kStripFrames;
    format.triangles = source.triangles();
    format.box_max = {c.far_away, 1.1F, 1.1F};
    auto encoder =
        FrameEncoder::create(format, settings_of_case(c, Profile::kMain, Preset::kFast),
                             [](std::span<const std::uint8_t> /*bytes*/) { return true; });
    ASSERT_TRUE(encoder);
    std::vector<float> xyz(3 * std::size_t{c.num_vertices});
    for (std::uint32_t f = 0; f < kStripFrames; ++f) {
      ASSERT_FALSE(source.read_frame(f, xyz));
      ASSERT_FALSE(encoder->add_frame(xyz));
    }
    const auto report = encoder->finish();
    ASSERT_TRUE(report);
    EXPECT_TRUE(report->target_met);
    EXPECT_LE(report->metrics.max_error, c.max_error);
  }
}

}  // namespace
}  // namespace rlpc
