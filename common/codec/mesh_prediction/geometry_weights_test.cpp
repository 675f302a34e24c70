#include "common/codec/mesh_prediction/geometry_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

namespace rlpc {
namespace {

constexpr std::int32_t kOne = 1 << kWeightFractionBits;
constexpr std::int32_t kRestBound = 1 << 28;  // rest positions have 29 bits

using Rest = std::vector<Vec3i>;
using Weights = std::vector<std::int32_t>;
using Real3 = std::array<double, 3>;

// Mesh of one vertex preceded by the vertices of its ring and outer ring.
struct Patch {
  std::size_t ring_size = 0;
  Rest rest;  // ring, outer ring, then the vertex
  WeightSettings weights;

  std::size_t outer_size() const { return rest.size() - 1 - ring_size; }
};

Weights weights_of(const Patch& patch) {
  const auto n = static_cast<std::uint32_t>(patch.rest.size());
  VertexLayers layers;
  layers.num_layers = 2;
  layers.layer_of_vertex.assign(n, 0);
  layers.layer_of_vertex[n - 1] = 1;
  layers.ring = VertexLists(n);
  layers.outer_ring = VertexLists(n);
  std::vector<std::uint32_t> order(n);
  for (std::uint32_t v = 0; v < n; ++v) order[v] = v;
  layers.layer_order = order;
  layers.ring.set(n - 1, std::span(order).first(patch.ring_size));
  layers.outer_ring.set(n - 1, std::span(order).subspan(patch.ring_size, patch.outer_size()));
  const Topology topology = make_topology(n, {});
  const OrderedMesh mesh(Prediction::kLayers, topology, layers);
  std::array<std::vector<std::int32_t>, 3> planes;
  for (const Vec3i& p : patch.rest) {
    for (std::size_t c = 0; c < 3; ++c) planes[c].push_back(p[c]);
  }
  const GeometryWeights weights(
      mesh, patch.weights,
      std::array<std::span<const std::int32_t>, 3>{planes[0], planes[1], planes[2]});
  const auto found = weights[n - 1];
  EXPECT_EQ(found.size(), patch.rest.size() - 1);
  EXPECT_EQ(weights[0].size(), 0U) << "a vertex without a ring";
  return {found.begin(), found.end()};
}

// Solves m x = b by elimination with pivoting. Returns false if it is nearly singular.
bool solve(std::array<std::array<double, 4>, 3> m, Real3& x) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i; r < 3; ++r) {
      if (std::abs(m[r][i]) > std::abs(m[pivot][i])) pivot = r;
    }
    std::swap(m[i], m[pivot]);
    if (std::abs(m[i][i]) < 1e-9) return false;
    for (std::size_t r = 0; r < 3; ++r) {
      if (r == i) continue;
      const double factor = m[r][i] / m[i][i];
      for (std::size_t k = i; k < 4; ++k) m[r][k] -= factor * m[i][k];
    }
  }
  for (std::size_t i = 0; i < 3; ++i) x[i] = m[i][3] / m[i][i];
  return true;
}

struct Exact {
  std::vector<double> weights;
  bool solved = false;
};

// The formula of 8.11 in floating point, without rounding: w = w0 + d, d = At (A At +
// lambda)^-1 r, where the mean of d over the ring is subtracted.
Exact exact_weights(const Patch& patch) {
  const std::size_t n = patch.ring_size;
  const std::size_t m = patch.outer_size();
  const double a = n < 2 || m == 0 ? 0.0 : patch.weights.outer_weight / 16.0;
  Exact exact;
  for (std::size_t k = 0; k < n + m; ++k) {
    exact.weights.push_back(k < n ? (1.0 + a) / static_cast<double>(n)
                                  : -a / static_cast<double>(m));
  }
  exact.solved = patch.weights.damping_log2 == 0;
  if (exact.solved) return exact;
  Real3 centre{};
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t c = 0; c < 3; ++c) centre[c] += patch.rest[k][c] / static_cast<double>(n);
  }
  std::vector<Real3> columns(n + m);
  std::array<std::array<double, 4>, 3> system{};
  double square = 0.0;
  for (std::size_t c = 0; c < 3; ++c) system[c][3] = patch.rest.back()[c] - centre[c];
  for (std::size_t k = 0; k < n + m; ++k) {
    const double scale = k < n ? 1.0 : patch.weights.outer_scale / 16.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double offset = patch.rest[k][c] - centre[c];
      if (k < n) square += offset * offset;
      system[c][3] -= exact.weights[k] * offset;
      columns[k][c] = scale * offset;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) system[i][j] += columns[k][i] * columns[k][j];
    }
  }
  const double damping =
      square / static_cast<double>(n) * std::exp2(-patch.weights.damping_log2);
  for (std::size_t i = 0; i < 3; ++i) system[i][i] += damping;
  Real3 solution{};
  exact.solved = solve(system, solution);
  double total = 0.0;
  for (std::size_t k = 0; k < n + m; ++k) {
    double change = 0.0;
    for (std::size_t c = 0; c < 3; ++c) change += columns[k][c] * solution[c];
    if (k >= n) change *= patch.weights.outer_scale / 16.0;
    exact.weights[k] += change;
    total += change;
  }
  for (std::size_t k = 0; k < n; ++k) exact.weights[k] -= total / static_cast<double>(n);
  return exact;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  std::int32_t within(std::int32_t bound) {
    return static_cast<std::int32_t>(engine_() % (2 * static_cast<std::uint64_t>(bound))) -
           bound;
  }

 private:
  std::mt19937_64 engine_;
};

void expect_legal(const Weights& weights) {
  std::int64_t sum = 0;
  std::int64_t magnitudes = 0;
  for (const std::int32_t w : weights) {
    sum += w;
    magnitudes += std::abs(std::int64_t{w});
  }
  EXPECT_EQ(sum, kOne);
  EXPECT_LT(magnitudes, std::int64_t{1} << 24) << "the bound of 8.10.3";
}

Patch random_patch(Random& random, std::int32_t bound) {
  Patch patch;
  patch.ring_size = 2 + random.below(kMaxRing - 1);
  patch.rest.resize(patch.ring_size + random.below(kMaxOuterRing + 1) + 1);
  for (Vec3i& p : patch.rest) {
    for (std::int32_t& x : p) x = random.within(bound);
  }
  patch.weights.damping_log2 = static_cast<int>(random.below(16));
  patch.weights.outer_weight = static_cast<int>(random.below(16));
  patch.weights.outer_scale = static_cast<int>(random.below(16));
  return patch;
}

// For typical rings, which are wide and not flat, the integers follow the formula within the
// precision of the offsets (11 bits) and the moments (14 bits).
TEST(GeometryWeights, FollowTheFormula) {
  Random random(1);
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < 4000; ++i) {
    Patch patch = random_patch(random, 1);
    patch.weights.damping_log2 = static_cast<int>(random.below(7));
    patch.ring_size = std::clamp<std::size_t>(patch.ring_size, 5, patch.rest.size() - 1);
    if (patch.ring_size < 5) continue;
    const double size = std::exp2(11 + random.below(17));
    for (std::size_t k = 0; k < patch.rest.size(); ++k) {
      const double radius = k < patch.ring_size ? 0.45 : k + 1 < patch.rest.size() ? 0.9 : 0.15;
      const double angle =
          6.2831853 * static_cast<double>(k) / static_cast<double>(patch.ring_size);
      const double height = 0.25 * std::cos(2 * angle) + random.within(1000) / 20000.0;
      patch.rest[k] = {static_cast<std::int32_t>(size * radius * std::cos(angle)),
                       static_cast<std::int32_t>(size * radius * std::sin(angle)),
                       static_cast<std::int32_t>(size * height)};
    }
    const Weights weights = weights_of(patch);
    expect_legal(weights);
    const Exact exact = exact_weights(patch);
    ASSERT_TRUE(exact.solved);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double error = std::abs(weights[k] / static_cast<double>(kOne) - exact.weights[k]);
      ASSERT_LT(error, 0.02) << i << ": weight " << k << " of " << weights.size();
      sum += error;
      ++count;
    }
  }
  EXPECT_GT(count, 10000);
  EXPECT_LT(sum / count, 0.0006);
}

// With the least damping, a ring that spans space predicts the exact position of the vertex.
TEST(GeometryWeights, PredictTheExactPosition) {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    Patch patch;
    patch.ring_size = 6;
    const std::int32_t d = 100'000 + static_cast<std::int32_t>(random.below(1000));
    patch.rest = {{d, 0, 0}, {-d, 0, 0}, {0, d, 0}, {0, -d, 0}, {0, 0, d}, {0, 0, -d}, {}};
    for (Vec3i& p : patch.rest) {
      for (std::int32_t& x : p) x += random.within(d / 4);
    }
    patch.weights.damping_log2 = 15;
    const Weights weights = weights_of(patch);
    for (std::size_t c = 0; c < 3; ++c) {
      double place = 0.0;
      for (std::size_t k = 0; k < 6; ++k) {
        place += weights[k] / static_cast<double>(kOne) * patch.rest[k][c];
      }
      EXPECT_NEAR(place, patch.rest[6][c], 0.004 * d) << i;
    }
  }
}

// 8.11.1: everything is relative to the centre of the ring.
TEST(GeometryWeights, AreInvariantUnderTranslation) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    Patch patch = random_patch(random, 1 << 20);
    const Weights weights = weights_of(patch);
    for (Vec3i& p : patch.rest) p = {p[0] + 123'456'789, p[1] - 98'765'432, p[2] + 1};
    EXPECT_EQ(weights_of(patch), weights) << i;
  }
}

TEST(GeometryWeights, ArePlainWeightsForARegularRing) {
  Patch patch;
  patch.ring_size = 4;
  patch.rest = {{1000, 0, 0}, {0, 1000, 0}, {-1000, 0, 0}, {0, -1000, 0}, {0, 0, 0}};
  EXPECT_EQ(weights_of(patch), (Weights{4096, 4096, 4096, 4096}));
  // The first vertex absorbs the rounding error: 3 / 5461.33, and 5 / 3276.8 with an outer
  // ring.
  patch.ring_size = 3;
  patch.rest = {{900, 0, 0}, {-450, 780, 0}, {-450, -780, 0}, {0, 0, 0}};
  EXPECT_EQ(weights_of(patch), (Weights{5462, 5461, 5461}));
}

// (16 + a) / 16 n and -a / 16 m.
TEST(GeometryWeights, PlainWeightsOfAnOuterRingAreNegative) {
  Patch patch;
  patch.ring_size = 4;
  patch.rest = {{1000, 0, 0}, {0, 1000, 0},  {-1000, 0, 0}, {0, -1000, 0},
                {2000, 0, 0}, {-2000, 0, 0}, {0, 0, 0}};
  patch.weights.outer_weight = 4;
  EXPECT_EQ(weights_of(patch), (Weights{5120, 5120, 5120, 5120, -2048, -2048}));
  patch.weights.outer_weight = 15;
  EXPECT_EQ(weights_of(patch), (Weights{7936, 7936, 7936, 7936, -7680, -7680}));
}

// A ring of one vertex does not determine a position; there is no outer ring then.
TEST(GeometryWeights, UseOnlyTheVertexOfARingOfOne) {
  Patch patch;
  patch.ring_size = 1;
  patch.rest = {{5, 6, 7}, {100, 0, 0}};
  patch.weights.outer_weight = patch.weights.outer_scale = 15;
  EXPECT_EQ(weights_of(patch), Weights{kOne});
}

// Moments of 14 bits cannot represent the least damping: the determinant is zero, and the plain
// weights are kept.
TEST(GeometryWeights, ArePlainWeightsForALineWithLittleDamping) {
  Patch patch;
  patch.ring_size = 4;
  patch.weights.damping_log2 = 15;
  patch.rest = {
      {-30'000, 0, 0}, {-10'000, 0, 0}, {10'000, 0, 0}, {30'000, 0, 0}, {7'000, 0, 0}};
  EXPECT_EQ(weights_of(patch), (Weights{4096, 4096, 4096, 4096}));
  patch.weights.damping_log2 = 4;
  EXPECT_NE(weights_of(patch), (Weights{4096, 4096, 4096, 4096}));
}

// Points, lines and planes, in all directions, at the ends of all ranges.
TEST(GeometryWeights, SumToOneForSingularRings) {
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    Patch patch = random_patch(random, 1);
    const std::int32_t bound = 1 << random.below(29);
    std::array<Vec3i, 3> direction{};
    const std::uint32_t rank = random.below(4);
    for (std::uint32_t k = 0; k < rank; ++k) {
      for (std::int32_t& x : direction[k]) x = random.within(bound / 3 + 1);
    }
    const Vec3i corner = {random.within(kRestBound), kRestBound - 1, -kRestBound};
    for (Vec3i& p : patch.rest) {
      Vec3i place{};
      for (const Vec3i& d : direction) {
        const std::int32_t factor = random.within(2);
        for (std::size_t c = 0; c < 3; ++c) place[c] += factor * d[c];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        place[c] += i % 3 == 0 ? corner[c] : 0;
        p[c] = std::clamp(place[c], -kRestBound, kRestBound - 1);
      }
    }
    expect_legal(weights_of(patch));
    if (HasFailure()) FAIL() << i;
  }
}

// Only corners of the range: offsets, moments and changes are as large as possible.
TEST(GeometryWeights, SumToOneForTheLargestOffsets) {
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    Patch patch = random_patch(random, 1);
    for (Vec3i& p : patch.rest) {
      for (std::int32_t& x : p) x = random.below(2) == 0 ? -kRestBound : kRestBound - 1;
    }
    if (i % 2 == 0) patch.rest.back() = {kRestBound - 1, kRestBound - 1, kRestBound - 1};
    if (i % 4 == 0) {  // the vertex far from a small ring
      for (std::size_t k = 0; k + 1 < patch.rest.size(); ++k) {
        for (std::int32_t& x : patch.rest[k])
          x = -kRestBound + static_cast<std::int32_t>(random.below(1U << (i % 28)));
      }
    }
    expect_legal(weights_of(patch));
    if (HasFailure()) FAIL() << i;
  }
}

}  // namespace
}  // namespace rlpc
