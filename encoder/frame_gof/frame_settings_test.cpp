#include "encoder/frame_gof/frame_settings.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/mesh/coded_meshes.h"
#include "common/testing/tube.h"

namespace rlpc {
namespace {

FrameSettings settings_with(FrameWeights weights) {
  SequenceHeader header;
  header.num_vertices = 12;
  header.level_idc = 1;
  const std::vector<Triangle> triangles = tube_triangles(3, 4);
  const Topology topology = make_topology(header.num_vertices, triangles);
  const CodedMeshes meshes(topology, triangles);
  EncoderSettings settings;
  settings.frames.weights = weights;
  return choose_frame_settings(header, settings, meshes[Prediction::kLayers], 8.0);
}

TEST(FrameSettings, PlainWeightsAreTheMeanOfTheRing) {
  const FrameSettings s = settings_with(FrameWeights::kPlain);
  EXPECT_EQ(s.weights.damping_log2, 0);
  EXPECT_EQ(s.weights.outer_weight, 0);
  EXPECT_FALSE(s.learning_flag);
}

TEST(FrameSettings, OtherWeightsDependOnTheFirstFrame) {
  for (const FrameWeights weights : {FrameWeights::kGeometry, FrameWeights::kLearned}) {
    const FrameSettings s = settings_with(weights);
    EXPECT_GT(s.weights.damping_log2, 0);
    EXPECT_GT(s.weights.outer_weight, 0);
    EXPECT_EQ(s.learning_flag, weights == FrameWeights::kLearned);
  }
}

}  // namespace
}  // namespace rlpc
