#include "encoder/codec/sequence/target/quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

class OneFrame final : public FrameSource {
 public:
  OneFrame(std::vector<float> xyz, std::vector<Triangle> triangles)
      : FrameSource({static_cast<std::uint32_t>(xyz.size() / 3), 1, {}, std::move(triangles)}),
        xyz_(std::move(xyz)) {}
  std::optional<InputError> read_frame(std::uint32_t, std::span<float> xyz) override {
    std::copy(xyz_.begin(), xyz_.end(), xyz.begin());
    return std::nullopt;
  }

 private:
  std::vector<float> xyz_;
};

Metrics with_rms(double rms) {
  Metrics metrics;
  metrics.rms_error = rms;
  return metrics;
}

// Edges of 3, 4 and 5: the median is 4.
TEST(Quality, ErrorsAreRelativeToTheMedianEdge) {
  OneFrame source({0, 0, 0, 3, 0, 0, 0, 4, 0}, {{0, 1, 2}, {0, 2, 1}});
  const auto small = measure_visibility(source, with_rms(0.119));
  ASSERT_TRUE(small && *small);
  EXPECT_EQ((*small)->median_edge, 4);
  EXPECT_DOUBLE_EQ((*small)->error_percent, 2.975);
  EXPECT_FALSE((*small)->visible());
  const auto large = measure_visibility(source, with_rms(0.121));
  ASSERT_TRUE(large && *large);
  EXPECT_TRUE((*large)->visible());
}

TEST(Quality, IsUnknownWithoutEdges) {
  OneFrame points({0, 0, 0, 3, 0, 0}, {});
  const auto none = measure_visibility(points, with_rms(1));
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
  OneFrame collapsed({1, 1, 1, 1, 1, 1, 1, 1, 1}, {{0, 1, 2}});
  const auto zero = measure_visibility(collapsed, with_rms(1));
  ASSERT_TRUE(zero);
  EXPECT_FALSE(*zero);
}

TEST(Quality, WordsGoFromCoarseToFine) {
  for (std::size_t i = 1; i < kQualities.size(); ++i) {
    EXPECT_LT(kQualities[i].kg_error_percent, kQualities[i - 1].kg_error_percent);
    EXPECT_LT(kQualities[i].max_normals, kQualities[i - 1].max_normals);
  }
}

TEST(Quality, BoundsNormalsButNotInLowDelayMode) {
  for (const NamedQuality& q : kQualities) {
    EXPECT_EQ(q.target(false).value, q.kg_error_percent);
    EXPECT_EQ(q.target(false).max_normals, q.max_normals);
    EXPECT_EQ(q.target(true).value, q.kg_error_percent / 2);
    EXPECT_EQ(q.target(true).max_normals, 0.0);
  }
}

}  // namespace
}  // namespace rlpc
