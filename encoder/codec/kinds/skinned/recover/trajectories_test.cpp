#include "encoder/codec/kinds/skinned/recover/trajectories.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/skinned/fit/vertex_rings.h"
#include "encoder/codec/spans/span_frames.h"
#include "encoder/testing/random_points.h"

namespace rlpc {
namespace {

using Numbers = std::vector<std::uint32_t>;

SpanFrames random_frames(std::uint32_t num_frames, std::uint32_t num_vertices) {
  RandomPoints random(1);
  SpanFrames frames{.num_vertices = num_vertices, .num_frames = num_frames, .xyz = {}};
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    const Vec3d place = 1e4 * random.point();
    for (std::uint32_t v = 0; v < num_vertices; ++v) {
      const Vec3d p = place + 300.0 * random.point();
      frames.xyz.insert(frames.xyz.end(), {p(0), p(1), p(2)});
    }
  }
  return frames;
}

// Returns frames with two vertices, that are at f + 1 in frame f, and at -(f + 1).
SpanFrames numbered_frames(std::uint32_t num_frames) {
  SpanFrames frames{.num_vertices = 2, .num_frames = num_frames, .xyz = {}};
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    const double x = f + 1.0;
    frames.xyz.insert(frames.xyz.end(), {x, 0.0, 0.0, -x, 0.0, 0.0});
  }
  return frames;
}

// Returns the numbers of the frames that a sample of numbered frames takes.
Numbers sampled(std::uint32_t num_frames, std::uint32_t max_frames) {
  const SpanFrames frames = numbered_frames(num_frames);
  const Trajectories t(frames, max_frames);
  Numbers numbers;
  for (std::size_t i = 0; i < t.num_frames(); ++i) {
    const double x = t.position(i, 0)(0) * t.extent() - 1.0;
    EXPECT_NEAR(x, std::round(x), 1e-9);
    numbers.push_back(static_cast<std::uint32_t>(std::lround(x)));
  }
  return numbers;
}

TEST(Trajectories, AreCentredInExtents) {
  const SpanFrames frames = random_frames(9, 30);
  const Trajectories t(frames, 5);
  ASSERT_EQ(t.num_frames(), 5U);
  ASSERT_EQ(t.num_vertices(), 30U);
  double square = 0.0;
  for (std::size_t f = 0; f < 5; ++f) {
    Vec3d mean = Vec3d::Zero();
    for (std::size_t v = 0; v < 30; ++v) {
      mean += t.position(f, v) / 30.0;
      square += t.position(f, v).squaredNorm();
    }
    EXPECT_LT(mean.norm(), 1e-12) << f;
  }
  EXPECT_NEAR(std::sqrt(square / (3.0 * 5.0 * 30.0)), 1.0, 1e-12);
}

// Differences of positions are those of the frames, of which the sample takes every second.
TEST(Trajectories, FollowTheVertices) {
  const SpanFrames frames = random_frames(9, 30);
  const Trajectories t(frames, 5);
  for (std::uint32_t v = 0; v < 30; ++v) {
    const std::vector<Vec3d> of = t.of(v);
    ASSERT_EQ(of.size(), 5U);
    for (std::uint32_t f = 0; f < 5; ++f) {
      EXPECT_EQ(of[f], t.position(f, v));
      const double* p = frames.at(2 * f, v);
      const double* q = frames.at(2 * f, 0);
      const Vec3d apart(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
      EXPECT_LT((t.extent() * (of[f] - t.position(f, 0)) - apart).norm(), 1e-9) << v;
    }
  }
}

TEST(Trajectories, TakeEvenlySpacedFrames) {
  EXPECT_EQ(sampled(7, 4), (Numbers{0, 2, 4, 6}));
  EXPECT_EQ(sampled(10, 4), (Numbers{0, 3, 6, 9}));
  EXPECT_EQ(sampled(10, 2), (Numbers{0, 9}));
  EXPECT_EQ(sampled(10, 1), (Numbers{0}));
  for (std::uint32_t num_frames = 2; num_frames < 60; ++num_frames) {
    for (std::uint32_t max_frames = 2; max_frames <= num_frames; ++max_frames) {
      const Numbers numbers = sampled(num_frames, max_frames);
      ASSERT_EQ(numbers.size(), max_frames);
      EXPECT_EQ(numbers.front(), 0U);
      EXPECT_EQ(numbers.back(), num_frames - 1);
      const std::uint32_t step = (num_frames - 1) / (max_frames - 1);
      for (std::size_t i = 1; i < numbers.size(); ++i) {
        EXPECT_GE(numbers[i] - numbers[i - 1], step) << num_frames << " " << max_frames;
        EXPECT_LE(numbers[i] - numbers[i - 1], step + 1) << num_frames << " " << max_frames;
      }
    }
  }
}

TEST(Trajectories, TakeAllOfFewFrames) {
  const Numbers all{0, 1, 2, 3, 4};
  EXPECT_EQ(sampled(5, 5), all);
  EXPECT_EQ(sampled(5, 6), all);
  EXPECT_EQ(sampled(5, 1000), all);
  EXPECT_EQ(sampled(1, 1000), (Numbers{0}));
}

TEST(Trajectories, AreZeroIfAllVerticesAreInOnePlace) {
  SpanFrames frames{.num_vertices = 4, .num_frames = 3, .xyz = {}};
  for (int f = 0; f < 3; ++f) {
    for (int v = 0; v < 4; ++v) {
      frames.xyz.insert(frames.xyz.end(), {8.0 * f, 5.0, -3.0});
    }
  }
  const Trajectories t(frames, 3);
  EXPECT_EQ(t.extent(), 0.0);
  for (std::size_t f = 0; f < 3; ++f) {
    for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(t.position(f, v), Vec3d(0, 0, 0));
  }
}

TEST(VertexRings, AreAscendingWithoutDuplicates) {
  const std::vector<Triangle> triangles{{2, 1, 0}, {1, 2, 3}};
  const VertexRings rings = vertex_rings(5, triangles);
  EXPECT_EQ(rings, (VertexRings{{1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2}, {}}));
  EXPECT_EQ(vertex_rings(2, {}), VertexRings(2));
}

TEST(VerticesAround, AreInTheOrderOfTheRings) {
  const std::vector<Triangle> triangles{{2, 1, 0}, {1, 2, 3}};
  const VertexRings rings = vertex_rings(5, triangles);
  EXPECT_EQ(vertices_around(rings, 0, 10), (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(vertices_around(rings, 3, 10), (Numbers{3, 1, 2, 0}));
  EXPECT_EQ(vertices_around(rings, 0, 3), (Numbers{0, 1, 2}));
  EXPECT_EQ(vertices_around(rings, 2, 1), (Numbers{2}));
  EXPECT_EQ(vertices_around(rings, 4, 10), (Numbers{4}));  // in no triangle

  std::vector<Triangle> strip;
  for (std::uint32_t i = 0; i < 8; ++i) strip.push_back({i, i + 1, i + 2});
  const VertexRings along = vertex_rings(10, strip);
  EXPECT_EQ(vertices_around(along, 4, 20), (Numbers{4, 2, 3, 5, 6, 0, 1, 7, 8, 9}));
  EXPECT_EQ(vertices_around(along, 4, 7), (Numbers{4, 2, 3, 5, 6, 0, 1}));
  EXPECT_EQ(vertices_around(along, 9, 4), (Numbers{9, 7, 8, 5}));
}

// Compares with distances along the edges of a sheet that relaxation finds.
TEST(VerticesAround, AreTheNearest) {
  constexpr std::uint32_t kSide = 7;
  std::vector<Triangle> sheet;
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t v = y * kSide + x;
      sheet.push_back({v, v + 1, v + kSide});
      sheet.push_back({v + 1, v + kSide + 1, v + kSide});
    }
  }
  const std::size_t n = kSide * kSide;
  const VertexRings rings = vertex_rings(n, sheet);
  for (std::uint32_t centre = 0; centre < n; ++centre) {
    std::vector<std::size_t> distance(n, n);
    distance[centre] = 0;
    for (std::size_t round = 0; round < n; ++round) {
      for (const Triangle& t : sheet) {
        const std::size_t nearest = std::min({distance[t[0]], distance[t[1]], distance[t[2]]});
        for (const std::uint32_t v : t) distance[v] = std::min(distance[v], nearest + 1);
      }
    }
    for (std::size_t count = 1; count <= n; count += 5) {
      const Numbers around = vertices_around(rings, centre, count);
      ASSERT_EQ(around.size(), count);
      std::vector<bool> is_inside(n, false);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_FALSE(is_inside[around[i]]);
        is_inside[around[i]] = true;
        EXPECT_GE(distance[around[i]], distance[around[i > 0 ? i - 1 : 0]]);
      }
      const std::size_t farthest = distance[around.back()];
      for (std::size_t v = 0; v < n; ++v) EXPECT_TRUE(is_inside[v] || distance[v] >= farthest);
    }
  }
}

}  // namespace
}  // namespace rlpc
