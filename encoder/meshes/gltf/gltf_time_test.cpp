// Tests the times of frames of glTF animations: from time 0 to the last key, at a rate that
// fits the keys.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "encoder/testing/gltf_files.h"

namespace rlpc {
namespace {

// One channel: a node's x, or its scale along x.
struct Track {
  std::string interpolation = "LINEAR";
  std::vector<float> times;
  std::vector<float> values;    // one per time
  std::vector<float> tangents;  // cubic: into and out of each

  // Returns the value at a time by glTF 2.0, appendix C, without our reader.
  double at(double time) const {
    if (time <= times.front()) return values.front();
    if (time >= times.back()) return values.back();
    std::size_t k = 0;
    while (times[k + 1] <= time) ++k;
    if (interpolation == "STEP") return values[k];
    const double duration = static_cast<double>(times[k + 1]) - times[k];
    const double t = (time - times[k]) / duration;
    if (interpolation == "LINEAR") return values[k] + t * (values[k + 1] - values[k]);
    return (2 * t * t * t - 3 * t * t + 1) * values[k] +
           duration * (t * t * t - 2 * t * t + t) * tangents[2 * k + 1] +
           (3 * t * t - 2 * t * t * t) * values[k + 1] +
           duration * (t * t * t - t * t) * tangents[2 * k + 2];
  }
};

struct Animation {
  Track x;
  Track scale;

  double end() const { return std::max<double>(x.times.back(), scale.times.back()); }
  bool is_at_frames(double rate, double tolerance) const {
    for (const Track* const track : {&x, &scale}) {
      for (const double t : track->times) {
        if (std::abs(t * rate - std::round(t * rate)) > tolerance) return false;
      }
    }
    return true;
  }
};

void add_channel(GltfBuilder& builder, const char* path, const Track& track) {
  const bool is_cubic = track.interpolation == "CUBICSPLINE";
  const float other = std::string(path) == "scale" ? 1 : 0;
  std::vector<float> out;
  const auto put = [&](float value, float rest) { out.insert(out.end(), {value, rest, rest}); };
  for (std::size_t k = 0; k < track.times.size(); ++k) {
    if (is_cubic) put(track.tangents[2 * k], 0);
    put(track.values[k], other);
    if (is_cubic) put(track.tangents[2 * k + 1], 0);
  }
  builder.add_channel(0, path, builder.add("SCALAR", track.times), builder.add("VEC3", out),
                      track.interpolation.c_str());
}

GltfBuilder file_of(const std::vector<Animation>& animations) {
  GltfBuilder builder = one_triangle();
  for (std::size_t i = 0; i < animations.size(); ++i) {
    builder.push("animations", {{"name", "clip " + std::to_string(i)}});
    add_channel(builder, "translation", animations[i].x);
    add_channel(builder, "scale", animations[i].scale);
  }
  return builder;
}

class GltfTimeTest : public GltfFilesTest {
 protected:
  std::unique_ptr<FrameSource> open_at(const GltfBuilder& builder,
                                       const std::optional<FrameRate>& rate = {}) const {
    auto source = open_gltf({put("a.glb", builder.glb()), "", rate, {"all"}, false});
    EXPECT_TRUE(source) << source.error().message;
    return source ? std::move(*source) : nullptr;
  }
  std::unique_ptr<FrameSource> open_times(const std::vector<std::vector<float>>& clips) const {
    std::vector<Animation> animations;
    for (const std::vector<float>& times : clips) {
      Track track{"LINEAR", times, {}, {}};
      for (std::size_t k = 0; k < times.size(); ++k) {
        track.values.push_back(static_cast<float>(k));
      }
      animations.push_back({track, track});
    }
    return open_at(file_of(animations));
  }
};

std::vector<float> frames_at(double rate, int count, int first = 0) {
  std::vector<float> times;
  times.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) times.push_back(static_cast<float>((first + k) / rate));
  return times;
}

TEST_F(GltfTimeTest, FindsTheRateOfTheKeys) {
  for (const std::uint32_t rate : {30U, 24U, 25U, 50U, 60U, 48U, 120U, 100U, 90U, 240U}) {
    const auto source = open_times({frames_at(rate, 40)});
    EXPECT_EQ(source->frame_rate(), (FrameRate{rate, 1}));
    EXPECT_EQ(source->num_frames(), 40U) << rate;
    EXPECT_TRUE(source->notes().empty());
  }
  for (const std::uint32_t rate : {30000U, 24000U, 60000U}) {
    const auto source = open_times({frames_at(rate / 1001.0, 40)});
    EXPECT_EQ(source->frame_rate(), (FrameRate{rate, 1001}));
    EXPECT_EQ(source->num_frames(), 40U) << rate;
  }
  // Low rates have a multiple that moves smoothly.
  for (const auto& [keys, rate] :
       {std::pair{15U, 30U}, {12U, 24U}, {10U, 30U}, {8U, 24U}, {20U, 40U}, {5U, 30U}}) {
    EXPECT_EQ(open_times({frames_at(keys, 40)})->frame_rate(), (FrameRate{rate, 1}));
  }
}

TEST_F(GltfTimeTest, FindsTheRateOfKeysInMilliseconds) {
  for (const std::uint32_t rate : {30U, 24U, 60U}) {
    std::vector<float> times = frames_at(rate, 50);
    for (float& t : times) t = std::round(t * 1000) / 1000;
    const auto source = open_times({times});
    EXPECT_EQ(source->frame_rate(), (FrameRate{rate, 1}));
    EXPECT_EQ(source->num_frames(), 50U) << rate;
  }
}

// Keys at a hundredth of a second by hand do not make a hundred frames per second.
TEST_F(GltfTimeTest, SparseKeysDoNotMultiplyFrames) {
  const auto source = open_times({{0, 0.41F, 1.37F, 2.03F}});
  EXPECT_LT(source->num_frames(), 64U);
  EXPECT_FLOAT_EQ(frame_of(*source, source->num_frames() - 1)[0], 3);
  const double rate =
      static_cast<double>(source->frame_rate().numerator) / source->frame_rate().denominator;
  EXPECT_NEAR((source->num_frames() - 1) / rate, 2.03, 1e-6);
  ASSERT_EQ(source->notes().size(), 1U);
  expect_text(source->notes()[0], "'frame_rate'");
}

TEST_F(GltfTimeTest, SeveralRatesTakeThatOfMostClipsAndSaySo) {
  const auto source =
      open_times({frames_at(24, 12), frames_at(25, 20), frames_at(24, 20), {0, 0.313F}});
  EXPECT_EQ(source->frame_rate(), (FrameRate{24, 1}));
  ASSERT_EQ(source->notes().size(), 1U);
  expect_text(source->notes()[0],
              "sampled at 24 frames per second, where those of 2 of 4 lie, and last poses "
              "come up to 0.032 s late; 'frame_rate' sets another rate");
  const std::vector<Clip>& clips = source->clips();
  EXPECT_EQ(clips[1].num_frames, 20U);  // the 18th and a part
  EXPECT_EQ(clips[3].num_frames, 9U);   // half of the 8th
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const float last = std::vector<float>{11, 19, 19, 1}[i];
    EXPECT_FLOAT_EQ(frame_of(*source, clips[i].last_frame())[0], last);
  }
}

TEST_F(GltfTimeTest, EndsOfAllClipsAreFramesWhereTheirKeysAreNot) {
  for (const auto& clips : std::vector<std::vector<std::vector<float>>>{
           {{0, 0.1234F, 0.52F, 3.48F}}, {{0, 0.1234F, 3.48F}, frames_at(25, 20)}}) {
    const auto source = open_times(clips);
    EXPECT_EQ(source->frame_rate(), (FrameRate{25, 1}));
    EXPECT_EQ(source->clips()[0].num_frames, 88U);
    ASSERT_EQ(source->notes().size(), 1U);
    expect_text(source->notes()[0], "sampled at 25 frames per second, at which");
  }
}

TEST_F(GltfTimeTest, NamesARateThatHasAllKeys) {
  const auto source = open_times({frames_at(24, 12), frames_at(25, 20), frames_at(60, 31)});
  EXPECT_EQ(source->frame_rate(), (FrameRate{60, 1}));
  expect_text(source->notes().at(0),
              "; 'frame_rate' sets another rate, 600 has frames at all keys");
}

TEST_F(GltfTimeTest, RateOfTheFileIsTriedFirst) {
  GltfBuilder builder = moving_triangle();
  builder.json["asset"]["extras"]["frame_rate"] = "12";
  EXPECT_EQ(open_at(builder)->frame_rate(), (FrameRate{12, 1}));
  EXPECT_EQ(open_at(builder, FrameRate{5, 1})->frame_rate(), (FrameRate{5, 1}));
}

TEST_F(GltfTimeTest, StepsAreNotOneFrameLate) {
  for (const double rate : {24.0, 25.0, 30.0}) {
    for (const double error : {-2e-5, 2e-5}) {
      Track track{"STEP", {}, {}, {}};
      for (int k = 0; k < 40; ++k) {
        track.times.push_back(static_cast<float>(k == 0 ? 0 : k / rate + error));
        track.values.push_back(static_cast<float>(k));
      }
      const auto source = open_at(file_of({{track, track}}));
      ASSERT_EQ(source->num_frames(), 40U);
      for (std::uint32_t f = 0; f < 40; ++f) {
        EXPECT_EQ(frame_of(*source, f)[0], static_cast<float>(f));
      }
    }
  }
}

TEST_F(GltfTimeTest, KeysBeforeTimeZeroAreNotPlayed) {
  const auto source = open_times({{-1, 1}});
  EXPECT_EQ(source->num_frames(), 31U);
  EXPECT_FLOAT_EQ(frame_of(*source, 0)[0], 0.5);
  ASSERT_EQ(source->notes().size(), 1U);
  expect_text(source->notes()[0], "dropped what 1 animation has before time 0");
  EXPECT_EQ(open_times({{-2, -1}})->num_frames(), 1U);
}

TEST_F(GltfTimeTest, EqualTimesAreAnError) {
  Track track{"LINEAR", {0, 1, 1, 2}, {0, 1, 2, 3}, {}};
  expect_text(error_of(file_of({{track, track}})), "expected a time after the one before, 1");
}

// Tests random animations; results are computed from the keys alone.
class RandomTimes : public GltfTimeTest {
 protected:
  double real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  template <class T>
  T any(const std::vector<T>& values) {
    return values[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random_)];
  }

  std::vector<float> times(double rate) {
    const int count = 1 + below(30);
    std::vector<float> t;
    switch (below(6)) {
      case 0:  // every frame, perhaps from a late one on
        return frames_at(rate, count, below(2) * below(40));
      case 1:  // some frames
        for (int k = below(10), i = 0; i < count; ++i, k += 1 + below(9)) {
          t.push_back(static_cast<float>(k / rate));
        }
        return t;
      case 2:  // an end off the grid
        t = frames_at(rate, count);
        t.push_back(t.back() + static_cast<float>(real(0.001, 1)));
        return t;
      case 3:  // tiny or long
        return {0, static_cast<float>(std::exp(real(-18, 6)))};
      case 4:  // a jump: two keys that are nearly at the same time
        return {0, 0.5F, std::nextafter(0.5F, 1.0F), static_cast<float>(real(0.6, 2))};
      default:
        t = {static_cast<float>(real(0, 2))};
        for (int i = 1; i < count; ++i) {
          t.push_back(t.back() + static_cast<float>(std::exp(real(-5, 0))));
        }
        return t;
    }
  }

  Track track(double rate) {
    Track made;
    made.interpolation = any<std::string>({"LINEAR", "STEP", "CUBICSPLINE"});
    made.times = times(rate);
    for (std::size_t k = 0; k < made.times.size(); ++k) {
      made.values.push_back(static_cast<float>(real(-5, 5)));
      for (int i = 0; i < 2; ++i) made.tangents.push_back(static_cast<float>(real(-5, 5)));
    }
    return made;
  }

  // Expects a value of the track at a time, which rounding may have moved a little.
  static void expect_at(const Track& track, double time, double slack, double value) {
    double low = 1e9;
    double high = -1e9;
    for (int i = -4; i <= 4; ++i) {
      const double there = track.at(std::max(0.0, time + i * slack / 4));
      low = std::min(low, there);
      high = std::max(high, there);
    }
    const double near = 1e-4 + 0.1 * (high - low);
    EXPECT_TRUE(value >= low - near && value <= high + near)
        << value << " at " << time << ", not " << low << " to " << high;
  }

  void check(const std::vector<Animation>& animations, const std::optional<FrameRate>& wanted);

  std::mt19937 random_{20};
  std::uint64_t num_exact_ = 0;
};

void RandomTimes::check(const std::vector<Animation>& animations,
                        const std::optional<FrameRate>& wanted) {
  const auto source = open_at(file_of(animations), wanted);
  ASSERT_TRUE(source);
  const double rate =
      static_cast<double>(source->frame_rate().numerator) / source->frame_rate().denominator;
  const std::vector<Clip>& clips = source->clips();
  ASSERT_EQ(clips.size(), animations.size());
  bool are_at_frames = true;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const Animation& animation = animations[i];
    const Clip& clip = clips[i];
    are_at_frames = are_at_frames && animation.is_at_frames(rate, 2e-3);
    const double duration = (clip.num_frames - 1) / rate;
    const double end = animation.end();
    const double slack = 1.1e-3 / rate + end * 0x1p-22;
    EXPECT_GE(duration, end - slack);
    EXPECT_LT(duration, end + 1 / rate);
    const bool may_be_longer = wanted || animations.size() > 1 || end < 1e-3;
    if (!may_be_longer) {
      EXPECT_LE(duration, end + slack);
      ++num_exact_;
    }
    for (int j = 0; j < 12; ++j) {
      const auto middle = static_cast<std::uint32_t>(below(static_cast<int>(clip.num_frames)));
      const std::uint32_t f = j == 0 ? 0 : j == 1 ? clip.num_frames - 1 : middle;
      const std::vector<float> xyz = frame_of(*source, clip.first_frame + f);
      const bool is_last = f + 1 == clip.num_frames;
      const double time = is_last ? std::max(end, f / rate) : f / rate;
      const double around = f == 0 || is_last ? 0.0 : slack;
      expect_at(animation.x, time, around, xyz[0]);
      expect_at(animation.scale, time, around, xyz[3] - xyz[0]);
    }
  }
  EXPECT_TRUE(wanted || are_at_frames || !source->notes().empty());
}

TEST_F(RandomTimes, ComeOutAsTheyWentIn) {
  const std::vector<double> rates{30, 24, 25, 60, 30000 / 1001.0, 12, 15, 50, 120};
  for (int i = 0; i < 400 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const double rate = any(rates);
    std::vector<Animation> animations;
    for (int k = below(3); k >= 0; --k) {
      const double its_rate = below(4) == 0 ? any(rates) : rate;
      animations.push_back({track(its_rate), track(its_rate)});
    }
    std::optional<FrameRate> wanted;
    if (below(4) == 0) wanted = FrameRate{static_cast<std::uint32_t>(1 + below(100)), 1};
    check(animations, wanted);
  }
  EXPECT_GT(num_exact_, 50U);
}

}  // namespace
}  // namespace rlpc
