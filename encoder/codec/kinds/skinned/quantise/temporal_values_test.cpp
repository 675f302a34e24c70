#include "encoder/codec/kinds/skinned/quantise/temporal_values.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace rlpc {
namespace {

SharedRig rig_of(std::size_t num_vertices, std::size_t num_bones, Prediction prediction) {
  SharedRig rig;
  rig.influences.resize(num_vertices);
  rig.bones.resize(num_bones);
  rig.prediction = prediction;
  return rig;
}

TEST(TemporalError, RisesWithTheVerticesOfOneBone) {
  constexpr std::size_t kFrames = 100;
  double before = temporal_error(rig_of(300, 1, Prediction::kLayers), kFrames);
  EXPECT_DOUBLE_EQ(before, kTemporalError);
  for (const std::size_t num_vertices : {900U, 1200U, 1400U}) {
    const double found = temporal_error(rig_of(num_vertices, 1, Prediction::kLayers), kFrames);
    EXPECT_GT(found, before) << num_vertices;
    before = found;
  }
  const double limit = temporal_error(rig_of(1 << 20, 1, Prediction::kLayers), kFrames);
  EXPECT_GT(limit, before);
  EXPECT_DOUBLE_EQ(temporal_error(rig_of(1 << 21, 1, Prediction::kLayers), kFrames), limit);
}

TEST(TemporalError, IsConstantOtherwise) {
  for (const std::size_t num_vertices : {10U, 1U << 20}) {
    EXPECT_DOUBLE_EQ(temporal_error(rig_of(num_vertices, 2, Prediction::kLayers), 10),
                     kTemporalErrorOfBones);
    EXPECT_DOUBLE_EQ(temporal_error(rig_of(num_vertices, 1, Prediction::kParallelograms), 10),
                     kTemporalError);
  }
}

}  // namespace
}  // namespace rlpc
