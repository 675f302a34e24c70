// Tests that encode() gives the same bytes and errors on several threads as on one.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include "common/testing/tube.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A bumpy tube whose halves bend; with `noise`, vertices also move by themselves.
class Tube final : public FrameSource {
 public:
  static constexpr std::uint32_t kSides = 8;
  static constexpr std::uint32_t kRings = 24;
  using Fail = std::function<std::optional<InputError>(std::uint32_t frame, int read)>;

  Tube(std::uint32_t num_frames, double noise)
      : FrameSource({kSides * kRings, num_frames, {}, tube_triangles(kRings, kSides)}),
        noise_(noise) {}
  explicit Tube(Fail fail) : Tube(36, 0.0) { fail_ = std::move(fail); }

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    std::optional<InputError> error;
    if (fail_) error = fail_(frame, reads_++);
    EXPECT_FALSE(is_reading_.exchange(true)) << "two threads read at once";
    const double bend = 0.6 * std::sin(0.3 * frame);
    for (std::uint32_t v = 0; v < num_vertices(); ++v) {
      const double angle = 0.785398 * (v % kSides);
      const double radius =
          2.5 + 0.3 * std::sin(1.7 * v) + noise_ * std::sin(0.9 * (v % 13) * frame + 0.37 * v);
      const double along = (v >> 3U) - 0.5 * kRings;
      const double y = radius * std::cos(angle);
      const double turn = along > 0 ? bend : 0.0;
      xyz[3 * v] = static_cast<float>(std::cos(turn) * along - std::sin(turn) * y);
      xyz[3 * v + 1] = static_cast<float>(std::sin(turn) * along + std::cos(turn) * y);
      xyz[3 * v + 2] = static_cast<float>(radius * std::sin(angle));
    }
    is_reading_ = false;
    return error;
  }

 private:
  double noise_;
  Fail fail_;
  int reads_ = 0;
  std::atomic<bool> is_reading_ = false;
};

struct EncoderOutcome {
  InputResult<EncodeReport> report = InputError{};
  Bytes stream;
  std::vector<double> progress;
};

EncoderOutcome encoded(FrameSource& source, EncoderSettings settings, std::uint32_t threads) {
  settings.threads = threads;
  EncoderOutcome outcome;
  outcome.report = encode(
      source, settings,
      [&](std::span<const std::uint8_t> bytes) {
        outcome.stream.insert(outcome.stream.end(), bytes.begin(), bytes.end());
        return true;
      },
      [&](double done) { outcome.progress.push_back(done); });
  return outcome;
}

EncoderSettings settings_of(Profile profile, Preset preset, std::uint32_t gof_frames) {
  EncoderSettings settings;
  settings.profile = profile;
  settings.preset = preset;
  settings.gof_frames = gof_frames;
  settings.target.value = 0.3;
  return settings;
}

struct Case {
  const char* name;
  Profile profile;
  Preset preset;
  std::uint32_t gof_frames;
  double noise = 0.0;
  Target target = {Target::kKg, 0.3};
};

class EncoderThreads : public testing::TestWithParam<Case> {};

TEST_P(EncoderThreads, GiveTheSameBytes) {
  const Case& c = GetParam();
  EncoderSettings settings = settings_of(c.profile, c.preset, c.gof_frames);
  settings.target = c.target;
  Tube source(36, c.noise);
  const EncoderOutcome one = encoded(source, settings, 1);
  ASSERT_TRUE(one.report);
  EXPECT_GE(one.report->num_gofs, (36 + c.gof_frames - 1) / c.gof_frames);
  for (const std::uint32_t threads : {2U, 3U}) {
    const EncoderOutcome several = encoded(source, settings, threads);
    ASSERT_TRUE(several.report);
    EXPECT_TRUE(several.stream == one.stream) << threads << " threads";
    EXPECT_EQ(several.report->metrics.kg_error_percent, one.report->metrics.kg_error_percent);
    EXPECT_EQ(several.report->metrics.ramanathan_psnr_db,
              one.report->metrics.ramanathan_psnr_db);
    EXPECT_TRUE(std::is_sorted(several.progress.begin(), several.progress.end()));
    EXPECT_GE(several.progress.size(), several.report->num_gofs);
    EXPECT_EQ(several.progress.back(), 1.0);
  }
}

// The search for bones takes most of the time.
TEST(EncoderThreads, ProgressWithinOneGof) {
  Tube source(36, 0.0);
  const EncoderOutcome outcome =
      encoded(source, settings_of(Profile::kMain, Preset::kMedium, 36), 1);
  ASSERT_TRUE(outcome.report);
  EXPECT_EQ(outcome.report->num_gofs, 1U);
  const auto after_first = std::find(outcome.progress.begin(), outcome.progress.end(), 0.5);
  ASSERT_NE(after_first, outcome.progress.end());
  EXPECT_GE(after_first - outcome.progress.begin(), 4);
}

INSTANTIATE_TEST_SUITE_P(
    Encode, EncoderThreads,
    testing::Values(
        Case{"Fast", Profile::kMain, Preset::kFast, 12},
        Case{"Medium", Profile::kMain, Preset::kMedium, 18},
        Case{"OneGof", Profile::kMain, Preset::kMedium, 36},
        Case{"Clusters", Profile::kMain, Preset::kMedium, 12, 0.05},
        Case{"Slow", Profile::kMain, Preset::kSlow, 18},
        Case{"Rigs", Profile::kHigh, Preset::kMedium, 12},
        Case{"RigsFast", Profile::kHigh, Preset::kFast, 9},
        Case{"Baseline", Profile::kBaseline, Preset::kMedium, 12},
        Case{"Rate", Profile::kMain, Preset::kFast, 9, 0.0, {Target::kBpvf, 2.0}},
        Case{
            "LargestError", Profile::kMain, Preset::kFast, 12, 0.0, {Target::kMaxError, 0.05}}),
    [](const auto& of) { return std::string(of.param.name); });

// Whichever thread sees an error first, that of the earliest frame is returned.
TEST(EncoderThreadsErrors, AreThoseOfOneThread) {
  for (const Preset preset : {Preset::kFast, Preset::kMedium}) {
    for (const std::uint32_t threads : {1U, 2U, 3U}) {
      Tube source([](std::uint32_t frame, int read) -> std::optional<InputError> {
        const bool fails = read >= 72 && (frame == 9 || frame == 25 || frame == 33);
        if (!fails) return std::nullopt;
        return InputError{"frame " + std::to_string(frame)};
      });
      const auto outcome = encoded(source, settings_of(Profile::kMain, preset, 6), threads);
      ASSERT_FALSE(outcome.report);
      EXPECT_EQ(outcome.report.error().message, "frame 9") << threads;
      EXPECT_TRUE(outcome.stream.empty());
    }
  }
}

TEST(EncoderThreadsErrors, ExceptionsReachTheCaller) {
  for (const std::uint32_t threads : {1U, 2U, 3U}) {
    Tube source([](std::uint32_t frame, int read) -> std::optional<InputError> {
      if (read >= 72 && frame == 25) throw std::bad_alloc();
      return std::nullopt;
    });
    EXPECT_THROW(encoded(source, settings_of(Profile::kMain, Preset::kFast, 6), threads),
                 std::bad_alloc);
  }
}

}  // namespace
}  // namespace rlpc
