#include "encoder/codec/kinds/inter/inter_settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "common/codec/mesh/ordered_meshes.h"
#include "common/testing/tube.h"

namespace rlpc {
namespace {

InterSettings settings_with(InterWeights weights, const FramePattern& pattern = {}) {
  SequenceHeader header;
  header.num_vertices = 12;
  header.level_idc = 1;
  const std::vector<Triangle> triangles = tube_triangles(3, 4);
  const Topology topology = make_topology(header.num_vertices, triangles);
  const OrderedMeshes meshes(topology, triangles);
  EncoderSettings settings;
  settings.inter.weights = weights;
  return choose_frame_settings(header, settings, meshes[Prediction::kLayers], pattern, 64.0);
}

TEST(InterSettings, PlainWeightsAreTheMeanOfTheRing) {
  const InterSettings s = settings_with(InterWeights::kPlain);
  EXPECT_EQ(s.weights.damping_log2, 0);
  EXPECT_EQ(s.weights.outer_weight, 0);
  EXPECT_FALSE(s.learning_flag);
}

TEST(InterSettings, OtherWeightsDependOnTheFirstFrame) {
  for (const InterWeights weights : {InterWeights::kGeometry, InterWeights::kLearned}) {
    const InterSettings s = settings_with(weights);
    EXPECT_GT(s.weights.damping_log2, 0);
    EXPECT_GT(s.weights.outer_weight, 0);
    EXPECT_EQ(s.learning_flag, weights == InterWeights::kLearned);
  }
}

// A period of four has a frame each of depths 0 and 1, and two of depth 2.
TEST(InterSettings, StepsOfDepthsHaveTheMeanSquareOfTheStep) {
  const auto steps =
      settings_with(InterWeights::kLearned, {FramePattern::kDyadic, 2, {}, 1}).step;
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_LT(steps[0], steps[1]);
  EXPECT_LT(steps[1], steps[2]);
  const auto square = [&](std::size_t d) {
    const double step = steps[d] / double{kExactInterStep};
    return step * step;
  };
  EXPECT_NEAR((square(0) + square(1) + 2.0 * square(2)) / 4.0, 64.0 * 64.0, 40.0);
}

// All frames inherit the errors of the first, and fine layers those of coarse ones.
TEST(InterSettings, WhatOthersInheritHasSmallSteps) {
  const InterSettings s = settings_with(InterWeights::kLearned);
  EXPECT_LT(s.first_step, s.step[0]);
  ASSERT_GT(s.layer_step.size(), 2U);
  EXPECT_EQ(s.layer_step.back(), kMaxLayerStep);
  EXPECT_LT(s.layer_step.front(), kMaxLayerStep);
  EXPECT_TRUE(std::is_sorted(s.layer_step.begin(), s.layer_step.end()));
}

TEST(InterSettings, ResidualsFollowTheRingUnlessErrorsAreBound) {
  EncoderSettings settings;
  const FramePattern previous;
  const FramePattern dyadic{FramePattern::kDyadic, 2, {}, 1};
  settings.target = {Target::kKg, 0.1};
  EXPECT_EQ(residual_rule(settings, previous), ResidualRule::kFollowRing);
  EXPECT_EQ(residual_rule(settings, dyadic), ResidualRule::kCheapest);
  for (const Target::Kind kind : {Target::kMaxError, Target::kLossless}) {
    settings.target = {kind, 0.1};
    EXPECT_EQ(residual_rule(settings, previous), ResidualRule::kCheapest);
  }
  settings.target = {Target::kMaxError, 0.1};
  settings.low_delay = true;
  EXPECT_EQ(residual_rule(settings, previous), ResidualRule::kNearest);
}

}  // namespace
}  // namespace rlpc
