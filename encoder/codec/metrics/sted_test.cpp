#include "encoder/codec/metrics/sted.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "encoder/codec/metrics/points.h"
#include "encoder/testing/bumpy_sheet.h"

namespace rlpc {
namespace {

TEST(Sted, EdgesAreListedOnce) {
  const std::vector<Triangle> triangles{{2, 0, 1}, {1, 0, 3}, {3, 3, 1}, {2, 0, 1}};
  const std::vector<std::array<std::uint32_t, 2>> expected{
      {0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}};
  EXPECT_EQ(edges_of(triangles), expected);
}

// Follows the definition, one vertex after the other.
double plain_spatial(std::uint32_t num_vertices, std::span<const Triangle> triangles,
                     std::span<const float> original, std::span<const float> decoded) {
  const auto edges = edges_of(triangles);
  double total = 0;
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    std::set<std::uint32_t> near{v};
    for (const auto& [a, b] : edges) {
      if (a == v) near.insert(b);
      if (b == v) near.insert(a);
    }
    std::vector<std::array<double, 2>> found;  // l, ed
    double weight = 0;
    double mean = 0;
    for (const auto& [a, b] : edges) {
      if (near.size() == 1 || !(near.contains(a) || near.contains(b))) continue;
      const double l = distance(original, a, b);
      found.push_back({l, l > 0 ? (l - distance(decoded, a, b)) / l : 0});
      weight += l;
      mean += l * found.back()[1];
    }
    if (weight <= 0) continue;
    double variance = 0;
    for (const auto& [l, ed] : found)
      variance += l * (ed - mean / weight) * (ed - mean / weight);
    total += std::sqrt(variance / weight);
  }
  return total / num_vertices;
}

Frame random_frame(std::mt19937& random, std::uint32_t num_vertices, float size) {
  Frame xyz(3 * std::size_t{num_vertices});
  for (float& c : xyz) c = size * (static_cast<float>(random()) / 4294967296.0F - 0.5F);
  return xyz;
}

// Few vertices and many triangles: cycles of three edges that are no triangles, edges with any
// number of triangles, vertices without any, equal corners, vertices that coincide.
TEST(Sted, SpatialPartFollowsTheDefinitionOnRandomMeshes) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    const auto num_vertices = static_cast<std::uint32_t>(2 + random() % 12);
    std::vector<Triangle> triangles(random() % 14);
    for (Triangle& t : triangles) {
      for (auto& corner : t) corner = static_cast<std::uint32_t>(random() % num_vertices);
    }
    const Frame original = random_frame(random, num_vertices, 1);
    Frame coincident = original;
    std::copy_n(coincident.begin(), 3, coincident.end() - 3);
    for (const Frame& a : {original, coincident}) {
      Frame b = a;
      const Frame noise = random_frame(random, num_vertices, 0.2F);
      for (std::size_t i = 0; i < b.size(); ++i) b[i] += noise[i];
      const double expected = plain_spatial(num_vertices, triangles, a, b);
      EXPECT_NEAR(StedSpatial(num_vertices, triangles).add_frame(a, b), expected,
                  1e-9 + 1e-9 * expected)
          << "seed " << seed;
    }
  }
}

// A wheel whose hub has all edges in its neighbourhood, as every vertex has: two rings.
TEST(Sted, VerticesOfAWheelSeeAllItsSpokes) {
  constexpr std::uint32_t kRim = 50'000;
  std::vector<Triangle> triangles;
  Frame original{0, 0, 0};
  for (std::uint32_t i = 0; i < kRim; ++i) {
    triangles.push_back({0, 1 + i, 1 + (i + 1) % kRim});
    original.insert(original.end(), {std::cos(static_cast<float>(i)), 0, 1});
  }
  Frame decoded = original;
  for (std::size_t i = 3; i < decoded.size(); i += 6) decoded[i] *= 1.5F;
  StedSpatial sted(kRim + 1, triangles);
  EXPECT_GT(sted.add_frame(original, decoded), 0.01);  // quadratic: billions of steps
  EXPECT_EQ(sted.add_frame(original, original), 0);
}

// One edge of a strip is longer by half, its neighbour shorter by half: the differences have
// signs, so that this is not the same ratio.
TEST(Sted, DifferencesHaveSigns) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const Frame original{0, 0, 0, 2, 0, 0, 4, 0, 0};
  const Frame decoded{0, 0, 0, 3, 0, 0, 4, 0, 0};
  // Lengths 2, 2, 4; ed -0.5, 0.5, 0, whose mean is 0.
  EXPECT_NEAR(StedSpatial(3, triangles).add_frame(original, decoded),
              std::sqrt((2 * 0.25 + 2 * 0.25) / 8), 1e-15);
}

TEST(Sted, HasNoSpatialPartUnderScaling) {
  const std::vector<Triangle> triangles = sheet_triangles(4);
  EXPECT_EQ(StedSpatial(16, triangles).add_frame(sheet(4, 0, 1), sheet(4, 3, 2)), 0);
}

// Two vertices, of which one moves by step[f]; the decoded one by step[f] / 2. The diagonal
// is 4.
TEST(Sted, TemporalPartHasAWindowOfTenSteps) {
  const std::vector<float> steps{1, 2, 0, 0, 1, 5, 3, 0, 0, 0, 0, 2, 1, 4};
  StedTemporal sted(2);
  float x = 0;
  sted.add_frame(Frame{0, 0, 0, 4, 0, 0}, Frame{0, 0, 0, 4, 0, 0});
  std::vector<double> s;
  std::vector<double> difference;
  for (std::size_t f = 0; f < steps.size(); ++f) {
    x += steps[f];
    sted.add_frame(Frame{x, 0, 0, 4, 0, 0}, Frame{x / 2, 0, 0, 4, 0, 0});
    s.push_back(std::hypot(static_cast<double>(steps[f]) / 4, 0.0003));
    difference.push_back(
        std::abs(s.back() - std::hypot(static_cast<double>(steps[f]) / 8, 0.0003)));
    const std::vector<double> found = sted.steps();  // so far
    ASSERT_EQ(found.size(), f + 1);
    for (std::size_t i = 0; i <= f; ++i) {
      double sum = 0;
      double count = 0;
      for (std::size_t k = i < 5 ? 0 : i - 5; k <= std::min(i + 4, f); ++k) {
        sum += s[k];
        ++count;
      }
      EXPECT_NEAR(found[i], difference[i] / (sum / count) / 2, 1e-12) << f << ", " << i;
    }
  }
}

TEST(Sted, TemporalPartIsDefinedForPoints) {
  StedTemporal sted(1);
  sted.add_frame(Frame{1, 1, 1}, Frame{1, 1, 1});
  sted.add_frame(Frame{1, 1, 1}, Frame{1, 1, 2});
  EXPECT_NEAR(sted.steps().front(), (std::hypot(1.0, 0.0003) - 0.0003) / 0.0003, 1e-9);
}

}  // namespace
}  // namespace rlpc
