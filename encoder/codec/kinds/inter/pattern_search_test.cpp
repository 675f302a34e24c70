#include "encoder/codec/kinds/inter/pattern_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "common/parallel/for_each.h"
#include "common/testing/tube.h"
#include "encoder/codec/kinds/inter/frame_pattern_text.h"
#include "encoder/codec/kinds/inter/inter_gof_kind.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kRings = 16;
constexpr std::uint32_t kSides = 8;
constexpr double kStep = 20.0;

class PatternSearch : public testing::Test {
 protected:
  PatternSearch() {
    settings_.profile = Profile::kHigh;
    settings_.gof_kind = GofKind::kInter;
    settings_.inter.patches = 0;
    header_.profile_idc = kProfileHigh;
    header_.num_vertices = kRings * kSides;
    header_.position_bits = 16;
    header_.num_triangles = static_cast<std::uint32_t>(triangles_.size());
    topology_ = make_topology(header_.num_vertices, triangles_);
  }

  // Moves the vertices of a tube along each axis by shift( frame, vertex, axis ).
  using Shift = std::function<double(std::uint32_t f, std::uint32_t v, std::uint32_t c)>;
  SpanFrames tube(std::uint32_t num_frames, const Shift& shift) const {
    SpanFrames frames{header_.num_vertices, num_frames, {}};
    for (std::uint32_t f = 0; f < num_frames; ++f) {
      for (std::uint32_t v = 0; v < header_.num_vertices; ++v) {
        const std::uint32_t ring = v / kSides;
        const double around = 2.0 * std::acos(-1.0) / kSides * (v % kSides);
        frames.xyz.push_back(3000 * std::cos(around) + shift(f, v, 0));
        frames.xyz.push_back(3000 * std::sin(around) + shift(f, v, 1));
        frames.xyz.push_back(1500.0 * ring + shift(f, v, 2));
      }
    }
    return frames;
  }
  EncodedSpan encoded(const SpanFrames& frames, double step = kStep) const {
    const auto kind = make_inter_gof_kind(mesh_, settings_);
    return kind->make_coder(frames)->encode(step, step);
  }
  EncodedSpan encoded_with_error(const SpanFrames& frames, double squared_error) const {
    double step = kStep;
    for (int i = 0; i < 4; ++i) {
      step *= std::sqrt(squared_error / *encoded(frames, step).squared_error);
    }
    return encoded(frames, step);
  }
  // Returns the chosen pattern, which must cost no more than the others.
  std::string chosen(const SpanFrames& frames) {
    settings_.inter.pattern.reset();
    const EncodedSpan best = encoded(frames);
    EXPECT_EQ(best.choices.size(), 1U);
    std::string pattern = frame_pattern_text(best.choices.front().pattern);
    for (const char* const text : {"previous", "first", "dyadic:16", "dyadic:64"}) {
      if (text == pattern) continue;
      settings_.inter.pattern = parse_frame_pattern_text(text);
      const EncodedSpan other = encoded_with_error(frames, *best.squared_error);
      EXPECT_LE(bits_at_equal_error(bits_of(best), *best.squared_error),
                bits_at_equal_error(bits_of(other), *other.squared_error))
          << text;
    }
    settings_.inter.pattern.reset();
    return pattern;
  }

  EncoderSettings settings_;
  SequenceHeader header_;
  std::vector<Triangle> triangles_ = tube_triangles(kRings, kSides);
  Topology topology_;
  SequenceMesh mesh_{header_, topology_, triangles_, triangles_};
};

TEST_F(PatternSearch, SmoothMotionIsPredictedFromBothSides) {
  const std::string pattern =
      chosen(tube(129, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
        return 800 * std::sin(0.05 * f + 0.3 * v + c);
      }));
  EXPECT_TRUE(pattern.starts_with("dyadic:")) << pattern;
}

// No earlier frame is as near as the one before.
TEST_F(PatternSearch, RandomWalksArePredictedFromTheFrameBefore) {
  std::vector<double> walk(129 * 3 * header_.num_vertices);
  const std::size_t values = 3 * std::size_t{header_.num_vertices};
  std::minstd_rand random(1);
  for (std::size_t i = values; i < walk.size(); ++i) {
    walk[i] = walk[i - values] + static_cast<double>(random() % 400) - 200;
  }
  EXPECT_EQ(chosen(tube(129, [&](std::uint32_t f, std::uint32_t v,
                                 std::uint32_t c) { return walk[values * f + 3 * v + c]; })),
            "previous");
}

// Weights that are learned make up for what the frame before adds.
TEST_F(PatternSearch, TremblingIsPredictedFromTheFirstFrame) {
  settings_.inter.weights = InterWeights::kGeometry;
  EXPECT_EQ(chosen(tube(129,
                        [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
                          std::minstd_rand random(f * 7919 + v * 3 + c + 1);
                          random.discard(3);
                          return f == 0 ? 0 : random() % 200;
                        })),
            "first");
}

TEST_F(PatternSearch, DoesNotDependOnThreads) {
  const SpanFrames frames = tube(70, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
    return 800 * std::sin(0.05 * f + 0.3 * v + c);
  });
  const EncodedSpan one = encoded(frames);
  const Threads use(3);
  const EncodedSpan several = encoded(frames);
  ASSERT_EQ(several.units.size(), one.units.size());
  for (std::size_t i = 0; i < one.units.size(); ++i) {
    EXPECT_EQ(several.units[i].payload, one.units[i].payload) << i;
  }
}

TEST_F(PatternSearch, KnowsItsError) {
  const SpanFrames frames = tube(20, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
    return 800 * std::sin(0.5 * f + 0.3 * v + c);
  });
  const EncodedSpan gof = encoded(frames);
  ASSERT_TRUE(gof.squared_error);
  EXPECT_NEAR(*gof.squared_error, squared_error(frames, gof.frame), 1e-6 * *gof.squared_error);
}

// Two halves move against each other, with bumps that neighbours do not predict.
TEST_F(PatternSearch, RigidPartsGetPatches) {
  settings_.inter.patches.reset();
  const SpanFrames frames = tube(40, [](std::uint32_t f, std::uint32_t v, std::uint32_t c) {
    std::minstd_rand random(v * 3 + c + 1);
    random.discard(3);
    const auto bump = static_cast<double>(random() % 600);
    const double along = v < kRings * kSides / 2 ? 1.0 : -1.0;
    return bump + along * 30.0 * f * (c == 0 ? 1.0 : 0.3) +
           (c == 2 ? 900 * std::sin(0.4 * f) : 0);
  });
  const EncodedSpan best = encoded(frames);
  ASSERT_EQ(best.choices.size(), 1U);
  EXPECT_GT(best.choices.front().num_patches, 0U);
  settings_.inter.patches = 0;
  settings_.inter.pattern = best.choices.front().pattern;
  EXPECT_LT(bits_of(best), 0.8 * bits_of(encoded(frames)));
}

std::string texts(const std::vector<FramePattern>& patterns) {
  std::string text;
  for (const FramePattern& pattern : patterns) text += frame_pattern_text(pattern) + " ";
  return text;
}

TEST(PatternsOf, AreAllThatTheGofHasFramesFor) {
  EncoderSettings settings;
  EXPECT_EQ(texts(patterns_of(settings, false, 65)), "previous first dyadic:16 dyadic:64 ");
  EXPECT_EQ(texts(patterns_of(settings, false, 18)), "previous first dyadic:16 dyadic:64 ");
  EXPECT_EQ(texts(patterns_of(settings, false, 17)), "previous first dyadic:16 ");
  EXPECT_EQ(texts(patterns_of(settings, false, 2)), "previous first ");
  settings.inter.pattern = FramePattern{FramePattern::kDyadic, 3, {}, 1};
  EXPECT_EQ(texts(patterns_of(settings, false, 65)), "dyadic:8 ");
}

TEST(PatternsOf, AreInTheOrderOfFramesIfThereIsNoLoss) {
  EncoderSettings settings;
  settings.target = {Target::kLossless, 12};
  EXPECT_EQ(texts(patterns_of(settings, false, 65)), "previous first ");
  settings.inter.temporal_layers = 2;
  EXPECT_EQ(texts(patterns_of(settings, false, 65)), "dyadic:16 ");
}

TEST(PatternsOf, IsOneIfThereIsNoTimeToCompareOrToWait) {
  EncoderSettings settings;
  EXPECT_EQ(texts(patterns_of(settings, true, 65)), "previous ");
  settings.preset = Preset::kFast;
  EXPECT_EQ(texts(patterns_of(settings, false, 65)), "previous ");
}

TEST(PatternsOf, HaveTheTemporalLayersOfTheSettings) {
  EncoderSettings settings;
  settings.inter.temporal_layers = 5;
  EXPECT_EQ(texts(patterns_of(settings, false, 65)), "dyadic:16 dyadic:64 ");
  EXPECT_EQ(texts(patterns_of(settings, false, 3)), "dyadic:16 ");
  EXPECT_EQ(texts(patterns_of(settings, true, 65)), "dyadic:16 ");
  settings.inter.temporal_layers = 7;
  EXPECT_EQ(texts(patterns_of(settings, false, 65)), "dyadic:64 ");
}

TEST(PatchesOf, AreSeveralUnlessThereIsNoTimeToCompareOrToWait) {
  EncoderSettings settings;
  const std::vector<std::uint32_t> none{0};
  EXPECT_GT(patches_of(settings, false, 65).size(), 1U);
  EXPECT_EQ(patches_of(settings, true, 65), none);
  EXPECT_EQ(patches_of(settings, false, 1), none);
  settings.preset = Preset::kFast;
  EXPECT_EQ(patches_of(settings, false, 65), none);
  settings.inter.patches = 7;
  EXPECT_EQ(patches_of(settings, true, 65), std::vector<std::uint32_t>{7});
}

TEST(PatchesOf, AreComparedByTwoPatterns) {
  const FramePattern previous;
  const FramePattern first{FramePattern::kFirst, 1, {}, 1};
  const FramePattern dyadic{FramePattern::kDyadic, 4, {}, 1};
  const std::vector<InterChoice> expected{
      {previous, 0}, {previous, 9}, {dyadic, 0}, {dyadic, 9}};
  EXPECT_EQ(choices_of_patches({previous, first, dyadic}, {0, 9}), expected);
  EXPECT_EQ(choices_of_patches({previous, first}, {0, 9}).size(), 2U);
  EXPECT_EQ(choices_of_patches({dyadic}, {0, 9}).size(), 2U);
  EXPECT_EQ(choices_of_patches({previous, first, dyadic}, {3}).size(), 1U);
}

}  // namespace
}  // namespace rlpc
