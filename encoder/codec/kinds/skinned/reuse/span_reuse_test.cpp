#include "encoder/codec/kinds/skinned/reuse/span_reuse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/parallel/for_each.h"
#include "encoder/testing/kept_tube.h"

namespace rlpc {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double rms_error(const SpanFrames& frames, const EncodedSpan& encoded) {
  return std::sqrt(squared_error(frames, encoded.frame) /
                   static_cast<double>(frames.xyz.size()));
}

// The motion continues, but differs from before in detail.
TEST(SpanReuse, FurtherFramesOfTheSameMotionTakeTracksAlone) {
  const KeptTube tube;
  ASSERT_TRUE(tube.kept);
  const SpanFrames later = KeptTube::frames(bent, 40, 32);
  const EncodedSpan own = tube.encode_alone(later);
  const double max_cost = lagrangian_cost(own, later, kTubeStep);
  const auto encoded = encode_with_rig(tube.context, *tube.kept, later, kTubeStep, max_cost);
  ASSERT_TRUE(encoded);
  for (const auto& unit : encoded->units) EXPECT_NE(unit.type, UnitType::kRig);
  EXPECT_EQ(encoded->units.front().type, UnitType::kGof);
  EXPECT_FALSE(encoded->rig);
  EXPECT_LT(bits_of(*encoded), 0.6 * bits_of(own));
  EXPECT_LT(rms_error(later, *encoded), 1.2 * rms_error(later, own));
}

TEST(SpanReuse, SpansMayHaveSeveralGofs) {
  const KeptTube tube;
  const SpanFrames later = KeptTube::frames(bent, 40, 33, 3);
  const auto encoded = encode_with_rig(tube.context, *tube.kept, later, kTubeStep, kNoLimit);
  ASSERT_TRUE(encoded);
  std::uint32_t gofs = 0;
  for (const auto& unit : encoded->units) {
    if (unit.type == UnitType::kGof) ++gofs;
  }
  EXPECT_EQ(gofs, 3U);
  EXPECT_LT(rms_error(later, *encoded), kTubeStep);
}

// A further deformation of few degrees of freedom.
TEST(SpanReuse, OtherMotionGetsLocalComponentGroups) {
  const KeptTube tube;
  const SpanFrames later = KeptTube::frames(
      [](const Point& p, double f) {
        Point moved = bent(p, f);
        moved[1] += 700.0 * std::sin(0.6 * f) * std::sin(p[0] / 1500.0);
        return moved;
      },
      40, 32);
  const auto encoded = encode_with_rig(tube.context, *tube.kept, later, kTubeStep, kNoLimit);
  ASSERT_TRUE(encoded);
  EXPECT_GT(encoded->max_components, tube.kept->rig->trajectories.size());
  EXPECT_GT(encoded->num_factors,
            std::uint64_t{3 + encoded->max_components} * KeptTube::kVertices);
  const double own = rms_error(later, tube.encode_alone(later));
  EXPECT_LT(rms_error(later, *encoded), 1.3 * own);
}

// Finer steps than that of the rig need local component groups.
TEST(SpanReuse, ErrorsFollowTheStep) {
  const KeptTube tube;
  const SpanFrames later = KeptTube::frames(bent, 40, 32);
  double last = 1e9;
  for (const double step : {64.0, 16.0, 2.0}) {
    const auto encoded = encode_with_rig(tube.context, *tube.kept, later, step, kNoLimit);
    ASSERT_TRUE(encoded);
    const double error = rms_error(later, *encoded);
    EXPECT_LT(error, 0.9 * last) << step;
    last = error;
  }
}

// Each vertex moves by itself.
TEST(SpanReuse, RefusesWhatCostsMore) {
  const KeptTube tube;
  const SpanFrames later = KeptTube::frames(
      [](const Point& p, double f) {
        const double x = 400.0 * std::sin(p[1] * 12.9898 + p[2] * 78.233 + p[0] + 43758.5 * f);
        return Point{p[1] + x, p[0] - 0.7 * x, p[2] + x * std::cos(f)};
      },
      40, 32);
  const double max_cost = 0.5 * lagrangian_cost(tube.encode_alone(later), later, kTubeStep);
  EXPECT_FALSE(encode_with_rig(tube.context, *tube.kept, later, kTubeStep, max_cost));
}

TEST(SpanReuse, GivesTheSameBytesOnSeveralThreads) {
  const KeptTube tube;
  const SpanFrames later = KeptTube::frames(bent, 40, 40, 2);
  const auto one = encode_with_rig(tube.context, *tube.kept, later, kTubeStep, kNoLimit);
  const Threads threads(3);
  const auto three = encode_with_rig(tube.context, *tube.kept, later, kTubeStep, kNoLimit);
  ASSERT_TRUE(one && three);
  ASSERT_EQ(one->units.size(), three->units.size());
  for (std::size_t i = 0; i < one->units.size(); ++i) {
    EXPECT_EQ(one->units[i].payload, three->units[i].payload) << i;
  }
}

TEST(SpanReuse, CutsOfTemporalLayersDecode) {
  KeptTube tube;
  tube.settings.main.temporal_layers = 2;
  const SpanFrames later = KeptTube::frames(bent, 40, 32);
  const auto encoded = encode_with_rig(tube.context, *tube.kept, later, kTubeStep, kNoLimit);
  ASSERT_TRUE(encoded && encoded->cut);
  const double all = squared_error(later, encoded->frame);
  EXPECT_EQ(squared_error(later, encoded->cut(2)), all);
  EXPECT_GT(squared_error(later, encoded->cut(1)), all);
}

}  // namespace
}  // namespace rlpc
