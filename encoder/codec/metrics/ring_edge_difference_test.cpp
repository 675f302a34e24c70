#include "encoder/codec/metrics/ring_edge_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "encoder/codec/metrics/surface_metrics.h"
#include "encoder/testing/bumpy_sheet.h"

namespace rlpc {
namespace {

TEST(RingEdgeDifference, HaveNoSpatialPartUnderScaling) {
  const std::vector<Triangle> triangles = sheet_triangles(4);
  SurfaceAccumulator metrics(16, triangles);
  const double diagonal = std::sqrt(9 + 9 + 0.25);
  const double apart = 0.01 * diagonal;
  std::vector<double> changes;  // ed of the virtual edges
  std::vector<double> lengths;
  float shift = 0;
  for (const float step : {0.0F, 1.0F, 3.0F}) {
    shift += step;
    metrics.add_frame(sheet(4, shift, 1), sheet(4, shift, 2));
    if (step == 0) continue;
    lengths.push_back(std::hypot(step, apart));
    changes.push_back(std::abs(std::hypot(2 * step, apart) - lengths.back()) / lengths.back());
  }
  const SurfaceMetrics m = metrics.result();
  EXPECT_EQ(m.ring_spatial, 0);
  const double weight = lengths[0] + lengths[1];
  const double mean = (lengths[0] * changes[0] + lengths[1] * changes[1]) / weight;
  double variance = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    variance += lengths[i] * (changes[i] - mean) * (changes[i] - mean) / weight;
  }
  EXPECT_NEAR(m.ring_temporal, std::sqrt(variance), 1e-12);
  EXPECT_EQ(m.ring_difference, m.ring_temporal);
  EXPECT_EQ(m.max_normal_angle, 0);
  ASSERT_EQ(m.frames.size(), 3U);
  EXPECT_EQ(m.frames[0].ring_temporal, 0);
  EXPECT_EQ(m.frames[1].ring_temporal, m.ring_temporal);
  EXPECT_EQ(m.frames[2].ring_temporal, 0);
}

// A triangle with sides 3, 4 and 5; the side of length 3 is stretched to 6.
TEST(RingEdgeDifference, AgreeWithAHandComputedExample) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  SurfaceAccumulator metrics(3, triangles);
  metrics.add_frame(Frame{0, 0, 0, 3, 0, 0, 0, 4, 0}, Frame{0, 0, 0, 6, 0, 0, 0, 4, 0});
  const auto dev = [](double la, double da, double lb, double db) {
    return std::sqrt(la * lb) / (la + lb) * std::abs(da - db);
  };
  const double hypotenuse = (std::sqrt(52.0) - 5) / 5;
  const double sum = dev(3, 1, 4, 0) + dev(3, 1, 5, hypotenuse) + dev(4, 0, 5, hypotenuse);
  const SurfaceMetrics m = metrics.result();
  EXPECT_NEAR(m.ring_spatial, sum / 3, 1e-12);
  EXPECT_EQ(m.ring_temporal, 0);
  EXPECT_EQ(m.ring_difference, m.ring_spatial);
}

}  // namespace
}  // namespace rlpc
