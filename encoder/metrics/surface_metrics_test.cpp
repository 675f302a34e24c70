#include "encoder/metrics/surface_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace rlpc {
namespace {

using Frame = std::vector<float>;

// A bumpy grid of side * side vertices, translated by `shift` and scaled by `scale`.
Frame sheet(std::uint32_t side, float shift, float scale) {
  Frame xyz;
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const float bump = (x * 7 + y * 3) % 4 == 0 ? 0.5F : 0.0F;
      for (const float c : {static_cast<float>(x) + shift, static_cast<float>(y), bump}) {
        xyz.push_back(scale * c);
      }
    }
  }
  return xyz;
}

std::vector<Triangle> sheet_triangles(std::uint32_t side) {
  std::vector<Triangle> triangles;
  for (std::uint32_t y = 0; y + 1 < side; ++y) {
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const std::uint32_t v = y * side + x;
      triangles.push_back({v, v + 1, v + side});
      triangles.push_back({v + 1, v + side + 1, v + side});
    }
  }
  return triangles;
}

TEST(SurfaceMetrics, EdgesAreListedOnce) {
  const std::vector<Triangle> triangles{{2, 0, 1}, {1, 0, 3}, {3, 3, 1}, {2, 0, 1}};
  const std::vector<std::array<std::uint32_t, 2>> expected{
      {0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}};
  EXPECT_EQ(edges_of(triangles), expected);
}

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
  // The normals rotate with the mesh.
  EXPECT_GT(m.mean_normal_angle, 1);
}

TEST(SurfaceMetrics, HaveNoSpatialPartUnderScaling) {
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
  EXPECT_EQ(m.sted_spatial, 0);
  const double weight = lengths[0] + lengths[1];
  const double mean = (lengths[0] * changes[0] + lengths[1] * changes[1]) / weight;
  double variance = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    variance += lengths[i] * (changes[i] - mean) * (changes[i] - mean) / weight;
  }
  EXPECT_NEAR(m.sted_temporal, std::sqrt(variance), 1e-12);
  EXPECT_EQ(m.sted, m.sted_temporal);
  EXPECT_EQ(m.max_normal_angle, 0);
  ASSERT_EQ(m.frames.size(), 3U);
  EXPECT_EQ(m.frames[0].sted_temporal, 0);
  EXPECT_EQ(m.frames[1].sted_temporal, m.sted_temporal);
  EXPECT_EQ(m.frames[2].sted_temporal, 0);
}

// A triangle with sides 3, 4 and 5; the side of length 3 is stretched to 6.
TEST(SurfaceMetrics, AgreeWithAHandComputedExample) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  SurfaceAccumulator metrics(3, triangles);
  metrics.add_frame(Frame{0, 0, 0, 3, 0, 0, 0, 4, 0}, Frame{0, 0, 0, 6, 0, 0, 0, 4, 0});
  const auto dev = [](double la, double da, double lb, double db) {
    return std::sqrt(la * lb) / (la + lb) * std::abs(da - db);
  };
  const double hypotenuse = (std::sqrt(52.0) - 5) / 5;
  const double sum = dev(3, 1, 4, 0) + dev(3, 1, 5, hypotenuse) + dev(4, 0, 5, hypotenuse);
  const SurfaceMetrics m = metrics.result();
  EXPECT_NEAR(m.sted_spatial, sum / 3, 1e-12);
  EXPECT_EQ(m.sted_temporal, 0);
  EXPECT_EQ(m.sted, m.sted_spatial);
}

TEST(SurfaceMetrics, AreProportionalToNoise) {
  const std::vector<Triangle> triangles = sheet_triangles(20);
  std::vector<double> sted;
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
  }
  EXPECT_GT(sted[0], 0);
  EXPECT_NEAR(sted[1] / sted[0], 2, 0.02);
  EXPECT_NEAR(sted[2] / sted[1], 2, 0.02);
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
  EXPECT_EQ(m.mean_normal_angle, 0);

  const std::vector<Triangle> triangles{{0, 1, 1}};
  SurfaceAccumulator flat(2, triangles);
  flat.add_frame(Frame{1, 1, 1, 1, 1, 1}, Frame{0, 1, 0, 0, 0, 2});
  EXPECT_EQ(flat.result().sted, 0);
}

}  // namespace
}  // namespace rlpc
