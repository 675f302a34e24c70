#include "common/codec/mesh/vertex_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "common/testing/fnv1a.h"
#include "common/testing/triangle_mesh.h"

namespace rlpc {
namespace {

using Indices = std::vector<std::uint32_t>;
using Triangles = std::vector<Triangle>;

Indices ring(const VertexLayers& layers, std::size_t v) {
  return {layers.ring[v].begin(), layers.ring[v].end()};
}
Indices outer_ring(const VertexLayers& layers, std::size_t v) {
  return {layers.outer_ring[v].begin(), layers.outer_ring[v].end()};
}
Indices layer_of_vertex(const VertexLayers& layers) {
  return {layers.layer_of_vertex.begin(), layers.layer_of_vertex.end()};
}
std::uint32_t base_size(const VertexLayers& layers) {
  return static_cast<std::uint32_t>(
      std::count(layers.layer_of_vertex.begin(), layers.layer_of_vertex.end(), 0));
}

// Apexes 0 and 1, and `n` vertices in a circle from `first` on.
void add_bipyramid(Triangles& triangles, std::uint32_t first, std::uint32_t n) {
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = first + i;
    const std::uint32_t b = first + (i + 1) % n;
    triangles.push_back({0, a, b});
    triangles.push_back({1, b, a});
  }
}
TriangleMesh bipyramid(std::uint32_t n) {
  TriangleMesh mesh{n + 2, {}};
  add_bipyramid(mesh.triangles, 2, n);
  return mesh;
}
VertexLayers layers_of(const TriangleMesh& mesh) {
  return make_layers(mesh.num_vertices, mesh.triangles);
}

TEST(Layers, AreEmptyForAnEmptyMesh) {
  const VertexLayers layers = layers_of({0, {}});
  EXPECT_EQ(layers.num_layers, 1U);
  EXPECT_TRUE(layers.layer_order.empty());
}

TEST(Layers, AreOnlyTheBaseForAPointCloud) {
  const VertexLayers layers = layers_of({3, {}});
  EXPECT_EQ(layers.num_layers, 1U);
  EXPECT_EQ(layer_of_vertex(layers), (Indices{0, 0, 0}));
  EXPECT_EQ(layers.layer_order, (Indices{0, 1, 2}));
  EXPECT_EQ(ring(layers, 0), Indices{});
  EXPECT_EQ(ring(layers, 1), Indices{0});
  EXPECT_EQ(ring(layers, 2), Indices{1});
}

TEST(Layers, KeepATriangleAndATetrahedronInTheBase) {
  EXPECT_EQ(layers_of({3, {{0, 1, 2}}}).num_layers, 1U);
  EXPECT_EQ(layers_of({4, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}}}).num_layers, 1U);
}

TEST(Layers, AnOpenFanLosesItsCentre) {
  // 0 lies in the middle of an edge of the triangle 1 2 3; 4 and 5 are ears.
  const VertexLayers layers = layers_of({6, {{0, 1, 2}, {0, 2, 3}, {2, 1, 4}, {3, 2, 5}}});
  EXPECT_EQ(layers.num_layers, 2U);
  EXPECT_EQ(layers.layer_order, (Indices{1, 2, 3, 0, 4, 5}));
  EXPECT_EQ(ring(layers, 0), (Indices{1, 2, 3}));
  EXPECT_EQ(ring(layers, 1), Indices{});
  EXPECT_EQ(ring(layers, 2), Indices{1});
  EXPECT_EQ(ring(layers, 3), (Indices{1, 2}));
  EXPECT_EQ(ring(layers, 4), (Indices{2, 1}));
  EXPECT_EQ(outer_ring(layers, 0), Indices{}) << "4 and 5 are gone";
}

TEST(Layers, VerticesWithFewTrianglesAreRemovedFirst) {
  // A strip loses its ends; a double tetrahedron loses an apex, not a vertex of the belt.
  const VertexLayers strip = layers_of({4, {{0, 1, 2}, {0, 2, 3}}});
  EXPECT_EQ(strip.layer_order, (Indices{0, 2, 3, 1}));
  EXPECT_EQ(ring(strip, 1), (Indices{2, 0}));
  const VertexLayers belt =
      layers_of({5, {{3, 0, 1}, {3, 1, 2}, {3, 2, 0}, {4, 1, 0}, {4, 2, 1}, {4, 0, 2}}});
  EXPECT_EQ(belt.layer_order, (Indices{0, 1, 2, 4, 3}));
  EXPECT_EQ(ring(belt, 3), (Indices{0, 1, 2}));
}

TEST(Layers, RemovingAnEarLeavesNoHole) {
  // Vertex 4 is attached to the edge 1-2 of a tetrahedron.
  const VertexLayers layers =
      layers_of({5, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}, {2, 1, 4}}});
  EXPECT_EQ(layers.layer_order, (Indices{0, 1, 2, 3, 4}));
  EXPECT_EQ(layer_of_vertex(layers), (Indices{0, 0, 0, 0, 1}));
  EXPECT_EQ(ring(layers, 4), (Indices{2, 1}));
  EXPECT_EQ(outer_ring(layers, 4), (Indices{0, 3}));
}

TEST(Layers, TheFirstOfEquallyGoodTriangulationsWithoutOldEdgesIsTaken) {
  // An octahedron: without 0 there is an edge 2-4, so that 5 leaves an edge
  // 1-3.
  const VertexLayers layers = layers_of({6,
                                         {{0, 1, 2},
                                          {0, 2, 3},
                                          {0, 3, 4},
                                          {0, 4, 1},
                                          {5, 2, 1},
                                          {5, 3, 2},
                                          {5, 4, 3},
                                          {5, 1, 4}}});
  EXPECT_EQ(layers.num_layers, 2U);
  EXPECT_EQ(layers.layer_order, (Indices{1, 2, 3, 4, 0, 5}));
  EXPECT_EQ(ring(layers, 0), (Indices{1, 2, 3, 4}));
  EXPECT_EQ(ring(layers, 5), (Indices{1, 4, 3, 2}));
  EXPECT_EQ(outer_ring(layers, 0), Indices{}) << "5 is of the same layer";
}

TEST(Layers, AFanWithInconsistentWindingIsNotAFan) {
  // Around 0: 1 2 3 4, where 2-3 has the opposite orientation.
  const Triangles outside{{5, 2, 1}, {5, 3, 2}, {5, 4, 3}, {5, 1, 4}};
  Triangles triangles{{0, 1, 2}, {0, 3, 2}, {0, 3, 4}, {0, 4, 1}};
  triangles.insert(triangles.end(), outside.begin(), outside.end());
  EXPECT_EQ(layers_of({6, triangles}).layer_of_vertex[0], 0);
}

TEST(Layers, TwoFansAtAVertexAreNotAFan) {
  // Two tetrahedra, and two triangles, that meet in 0.
  const VertexLayers closed = layers_of({7,
                                         {{0, 1, 2},
                                          {0, 2, 3},
                                          {0, 3, 1},
                                          {3, 2, 1},
                                          {0, 4, 5},
                                          {0, 5, 6},
                                          {0, 6, 4},
                                          {6, 5, 4}}});
  EXPECT_EQ(closed.num_layers, 1U);
  EXPECT_EQ(layers_of({5, {{0, 1, 2}, {0, 3, 4}}}).layer_of_vertex[0], 0);
}

TEST(Layers, VerticesWithManyTrianglesAddNothingToOuterRings) {
  const VertexLayers twelve = layers_of(bipyramid(12));
  EXPECT_EQ(ring(twelve, 2), (Indices{0, 13, 1, 3}));
  EXPECT_EQ(outer_ring(twelve, 2), (Indices{5, 7, 9, 11}));
  const VertexLayers thirteen = layers_of(bipyramid(13));
  EXPECT_EQ(ring(thirteen, 2), (Indices{0, 14, 1, 3}));
  EXPECT_EQ(outer_ring(thirteen, 2), Indices{13});
}

TEST(Layers, BaseVerticesHaveTheHighestOfTheirEarlierNeighbours) {
  Triangles triangles;
  for (std::uint32_t i = 0; i < 8; ++i) triangles.push_back({9, i, i + 1});
  const Triangles once = triangles;
  triangles.insert(triangles.end(), once.begin(), once.end());  // no fans
  const VertexLayers layers = layers_of({10, triangles});
  EXPECT_EQ(layers.num_layers, 1U);
  EXPECT_EQ(ring(layers, 9), (Indices{2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(ring(layers, 8), Indices{7});
}

TEST(Layers, DegenerateTrianglesAreIgnored) {
  const VertexLayers layers = layers_of({4, {{0, 1, 2}, {0, 2, 3}, {0, 0, 3}, {1, 3, 1}}});
  EXPECT_EQ(ring(layers, 1), (Indices{2, 0}));
  EXPECT_EQ(layers.num_layers, 2U);
}

TEST(Layers, TwoVerticesWithManyTrianglesGetNoNewEdge) {
  // Bipyramids between the same apexes: around each other vertex, only 0-1 can
  // be new at last.
  constexpr std::uint32_t kBipyramids = 3000;
  TriangleMesh mesh{2 + 13 * kBipyramids, {}};
  for (std::uint32_t i = 0; i < kBipyramids; ++i) add_bipyramid(mesh.triangles, 2 + 13 * i, 13);
  EXPECT_EQ(base_size(layers_of(mesh)), 2 + 3 * kBipyramids);
}

// Checks the properties that the clause guarantees for every mesh.
void check(const TriangleMesh& mesh) {
  const VertexLayers layers = layers_of(mesh);
  const std::uint32_t n = mesh.num_vertices;
  ASSERT_EQ(layers.layer_of_vertex.size(), n);
  ASSERT_EQ(layers.ring.size(), n);
  ASSERT_EQ(layers.outer_ring.size(), n);
  ASSERT_LE(layers.num_layers, kMaxLayers);

  Indices order(n);
  for (std::uint32_t v = 0; v < n; ++v) order[v] = v;
  const auto& layer = layers.layer_of_vertex;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return layer[a] < layer[b]; });
  ASSERT_EQ(layers.layer_order, order);
  Indices sizes(layers.num_layers, 0);
  for (const std::uint8_t k : layer) ++sizes.at(k);
  std::uint32_t present = n;
  for (std::size_t k = sizes.size() - 1; k > 0; --k) {
    ASSERT_GT(sizes[k], 0U);
    ASSERT_TRUE(k == 1 || 16 * sizes[k] >= present) << "layer " << k;
    present -= sizes[k];
  }

  Indices base_before;
  for (std::uint32_t v = 0; v < n; ++v) {
    const Indices inner = ring(layers, v);
    const Indices outer = outer_ring(layers, v);
    std::set<std::uint32_t> all(inner.begin(), inner.end());
    all.insert(outer.begin(), outer.end());
    ASSERT_EQ(all.size(), inner.size() + outer.size());
    ASSERT_EQ(all.count(v), 0U);
    ASSERT_LE(inner.size(), kMaxRing);
    ASSERT_LT(outer.size(), 168U);
    ASSERT_TRUE(std::is_sorted(outer.begin(), outer.end()));
    if (layer[v] > 0) {
      ASSERT_GE(inner.size(), 2U);
      for (const std::uint32_t u : all) ASSERT_LT(layer[u], layer[v]);
      continue;
    }
    ASSERT_TRUE(outer.empty());
    ASSERT_EQ(inner.empty(), base_before.empty());
    ASSERT_TRUE(std::is_sorted(inner.begin(), inner.end()));
    for (const std::uint32_t u : inner) ASSERT_TRUE(u < v && layer[u] == 0);
    base_before.push_back(v);
  }
}

bool are_equal(const VertexLayers& x, const VertexLayers& y) {
  if (x.num_layers != y.num_layers || x.layer_of_vertex != y.layer_of_vertex ||
      x.layer_order != y.layer_order) {
    return false;
  }
  for (std::size_t v = 0; v < x.layer_of_vertex.size(); ++v) {
    if (ring(x, v) != ring(y, v) || outer_ring(x, v) != outer_ring(y, v)) return false;
  }
  return true;
}

// A surface with many defects: holes, flipped and repeated triangles, and triangles between
// random vertices.
TriangleMesh surface_with_defects(std::mt19937& random) {
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  TriangleMesh mesh = below(4) == 0 ? bipyramid(3 + below(40))
                                    : grid_mesh(3 + below(8), 3 + below(8), below(2) == 0);
  const std::uint32_t num_wrong = below(3) == 0 ? 0 : below(12);
  for (std::uint32_t i = 0; i < num_wrong; ++i) {
    const std::uint32_t at = below(static_cast<std::uint32_t>(mesh.triangles.size()));
    const Triangle t = mesh.triangles[at];
    switch (below(4)) {
      case 0:
        mesh.triangles.erase(mesh.triangles.begin() + at);
        break;
      case 1:
        mesh.triangles[at] = {t[1], t[0], t[2]};
        break;
      case 2:
        mesh.triangles.push_back(t);
        break;
      default: {
        const std::uint32_t n = mesh.num_vertices;
        mesh.triangles.push_back({below(n), below(n), below(n)});
      }
    }
    if (mesh.triangles.empty()) break;
  }
  mesh.num_vertices += below(3);
  renumber_vertices(mesh, random);
  return mesh;
}

TEST(Layers, HaveTheGuaranteedProperties) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    check(surface_with_defects(random));
  }
  check(grid_mesh(100, 90, false));
  check(grid_mesh(90, 100, true));
  check(bipyramid(1000));
}

TEST(Layers, DoNotDependOnTheOrderOfTriangles) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    TriangleMesh mesh = surface_with_defects(random);
    const VertexLayers layers = layers_of(mesh);
    for (Triangle& t : mesh.triangles) t = {t[1], t[2], t[0]};
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    EXPECT_TRUE(are_equal(layers_of(mesh), layers));
  }
}

std::uint32_t digest_of_layers(const VertexLayers& layers) {
  Fnv1a digest;
  digest.add(layers.layer_order);
  for (std::size_t v = 0; v < layers.ring.size(); ++v) {
    digest.add(layers.ring[v]);
    digest.add(layers.outer_ring[v]);
  }
  return digest.hash();
}

// The digests were computed by the pseudo-code of the clause.
TEST(Layers, AgreeWithThePseudoCode) {
  EXPECT_EQ(digest_of_layers(layers_of(grid_mesh(25, 20, false))), 3503261680U);
  EXPECT_EQ(digest_of_layers(layers_of(grid_mesh(25, 20, true))), 4047958968U);
  EXPECT_EQ(digest_of_layers(layers_of(bipyramid(300))), 2994101135U);
  TriangleMesh mesh = grid_mesh(30, 20, true);
  const std::size_t n = mesh.triangles.size();
  for (std::size_t i = 0; i < n; i += 17) {
    std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  }
  for (std::size_t i = 0; i < n; i += 23) {
    const Triangle t = mesh.triangles[i];
    mesh.triangles.push_back(t);
  }
  EXPECT_EQ(digest_of_layers(layers_of(mesh)), 2036378576U);
}

// Quadratic time, 10^12 steps, would exceed the time limit of tests.
TEST(Layers, TakeLinearTimeOnHostileMeshes) {
  constexpr std::uint32_t kMany = 1'000'000;
  TriangleMesh book{kMany, {}};
  TriangleMesh copies{kMany, {}};
  TriangleMesh fan{kMany, {}};
  for (std::uint32_t v = 2; v < kMany; ++v) {
    book.triangles.push_back({0, 1, v});
    copies.triangles.push_back({0, 1, 2});
    fan.triangles.push_back({0, v - 1, v});
  }
  EXPECT_EQ(base_size(layers_of(bipyramid(kMany))), 4U);
  EXPECT_EQ(base_size(layers_of(book)), 3U);
  EXPECT_EQ(base_size(layers_of(copies)), kMany);
  EXPECT_EQ(base_size(layers_of(fan)), 3U);
}

}  // namespace
}  // namespace rlpc
