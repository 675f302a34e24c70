#include "encoder/codec/metrics/surface_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "encoder/testing/bumpy_sheet.h"

namespace rlpc {
namespace {

TEST(SurfaceMetrics, AreZeroUnderRigidMotion) {
  const std::vector<Triangle> triangles = sheet_triangles(5);
  SurfaceAccumulator metrics(25, triangles);
  for (const float shift : {0.0F, 1.0F, 4.0F, 4.5F}) {
    const Frame original = sheet(5, shift, 1);
    Frame turned(original.size());  // a quarter turn about z and a translation, exact in float
    for (std::size_t v = 0; v < 25; ++v) {
      turned[3 * v] = 8 - original[3 * v + 1];
      turned[3 * v + 1] = original[3 * v] - 16;
      turned[3 * v + 2] = original[3 * v + 2] + 2;
    }
    metrics.add_frame(original, turned);
  }
  const SurfaceMetrics m = metrics.result();
  EXPECT_EQ(m.sted, 0);
  EXPECT_EQ(m.sted_spatial, 0);
  EXPECT_EQ(m.sted_temporal, 0);
  EXPECT_EQ(m.ring_difference, 0);
  // The normals rotate with the mesh.
  EXPECT_GT(m.mean_normal_angle, 1);
}

TEST(SurfaceMetrics, AreProportionalToNoise) {
  const std::vector<Triangle> triangles = sheet_triangles(20);
  std::vector<double> sted;
  std::vector<double> ring;
  for (const float size : {0.001F, 0.002F, 0.004F}) {
    SurfaceAccumulator metrics(400, triangles);
    std::mt19937 random(7);
    for (int f = 0; f < 6; ++f) {
      const Frame original = sheet(20, static_cast<float>(f), 1);
      Frame noisy = original;
      for (float& c : noisy) {
        c += size * (static_cast<float>(random()) / 4294967296.0F - 0.5F);
      }
      metrics.add_frame(original, noisy);
    }
    sted.push_back(metrics.result().sted);
    ring.push_back(metrics.result().ring_difference);
  }
  for (const std::vector<double>& found : {sted, ring}) {
    EXPECT_GT(found[0], 0);
    EXPECT_NEAR(found[1] / found[0], 2, 0.02);
    EXPECT_NEAR(found[2] / found[1], 2, 0.02);
  }
}

TEST(SurfaceMetrics, NormalAnglesAreWeightedByArea) {
  // Triangles of area 2 and 8 in the xy plane, and a degenerate one.
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {0, 1, 1}};
  const Frame original{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0};
  Frame decoded = original;
  SurfaceAccumulator metrics(6, triangles);
  metrics.add_frame(original, decoded);
  decoded[8] = 2;  // rotated by 45 degrees
  metrics.add_frame(original, decoded);
  decoded[16] = -4;  // upside down
  metrics.add_frame(original, decoded);
  decoded[16] = 0;  // degenerate
  metrics.add_frame(original, decoded);
  const SurfaceMetrics m = metrics.result();
  EXPECT_EQ(m.frames[0].max_normal_angle, 0);
  EXPECT_NEAR(m.frames[1].max_normal_angle, 45, 1e-9);
  EXPECT_NEAR(m.frames[1].mean_normal_angle, 45 * 0.2, 1e-9);
  EXPECT_EQ(m.frames[1].max_normal_triangle, 0U);
  EXPECT_NEAR(m.frames[2].mean_normal_angle, 45 * 0.2 + 180 * 0.8, 1e-9);
  EXPECT_NEAR(m.frames[3].max_normal_angle, 90, 1e-9);
  EXPECT_EQ(m.frames[3].max_normal_triangle, 1U);
  EXPECT_NEAR(m.max_normal_angle, 180, 1e-9);
  EXPECT_EQ(m.max_normal_frame, 2U);
  EXPECT_EQ(m.max_normal_triangle, 1U);
  EXPECT_NEAR(m.mean_normal_angle, (0 + 9 + (9 + 144) + (9 + 72)) / 4.0, 1e-9);
}

TEST(SurfaceMetrics, AreDefinedWithoutTrianglesAndForZeroSize) {
  SurfaceAccumulator points(2, {});
  for (int f = 0; f < 3; ++f)
    points.add_frame(Frame{0, 0, 0, 0, 0, 0}, Frame{0, 1, 0, 0, 0, 2});
  const SurfaceMetrics m = points.result();
  EXPECT_EQ(m.sted, 0);
  EXPECT_EQ(m.ring_difference, 0);
  EXPECT_EQ(m.mean_normal_angle, 0);

  EXPECT_FALSE(m.has_sted);

  const std::vector<Triangle> triangles{{0, 1, 1}};
  SurfaceAccumulator flat(2, triangles);
  flat.add_frame(Frame{1, 1, 1, 1, 1, 1}, Frame{0, 1, 0, 0, 0, 2});
  EXPECT_EQ(flat.result().sted, 0);
  EXPECT_EQ(flat.result().ring_difference, 0);
}

// Steps cannot be divided by the diagonal of a point, from which the animation grows.
TEST(SurfaceMetrics, HaveNoStedWhereTheFirstFrameIsAPoint) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  for (const float first : {0.0F, 1.0F}) {
    SurfaceAccumulator metrics(3, triangles);
    const Frame original{0, 0, 0, first, 0, 0, 0, first, 0};
    metrics.add_frame(original, original);
    metrics.add_frame(Frame{0, 0, 0, 5, 0, 0, 0, 5, 0}, Frame{0, 0, 0, 5, 0, 0, 0, 4, 0});
    const SurfaceMetrics m = metrics.result();
    EXPECT_EQ(m.has_sted, first > 0.0F);
    EXPECT_EQ(m.sted > 0.0, m.has_sted);
    EXPECT_EQ(m.frames[1].sted_temporal > 0.0, m.has_sted);
  }
}

}  // namespace
}  // namespace rlpc
