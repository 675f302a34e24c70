#include "common/codec/mesh/coarse_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
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
using Edge = std::pair<std::uint32_t, std::uint32_t>;

CoarseMeshes coarse_meshes(const TriangleMesh& mesh) {
  return {mesh.num_vertices, mesh.triangles};
}

// Makes a sphere: two poles and `rings` rings of n vertices.
TriangleMesh sphere(std::uint32_t rings, std::uint32_t n) {
  TriangleMesh mesh{2 + rings * n, {}};
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({0, 2 + i, 2 + j});
    for (std::uint32_t r = 2; r + n < mesh.num_vertices; r += n) {
      mesh.triangles.push_back({r + i, r + n + i, r + n + j});
      mesh.triangles.push_back({r + i, r + n + j, r + j});
    }
    const std::uint32_t last = mesh.num_vertices - n;
    mesh.triangles.push_back({1, last + j, last + i});
  }
  return mesh;
}

void renumber_by_seed(TriangleMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  renumber_vertices(mesh, random);
}

// Makes a mesh, also with triangles that are not a surface.
TriangleMesh mesh_with_stray_triangles(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  TriangleMesh mesh = grid_mesh(3 + below(9), 3 + below(9), below(2) == 0);
  for (std::uint32_t i = below(12); i > 0; --i) {
    const std::uint32_t n = mesh.num_vertices;
    mesh.triangles.push_back({below(n), below(n), below(n)});
    mesh.triangles.erase(mesh.triangles.begin() + below(n));
  }
  mesh.num_vertices += below(3);
  renumber_by_seed(mesh, seed);
  return mesh;
}

struct Surface {
  std::uint32_t boundary_edges = 0;
  std::int64_t euler_characteristic = 0;
};

// Requires that a mesh is an oriented manifold of all its vertices, with or without a boundary.
Surface surface(const CoarseMesh& mesh) {
  std::set<Edge> edges;
  // [vertex] its triangles, as pairs of the other two vertices.
  std::vector<std::map<std::uint32_t, std::uint32_t>> fans(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(edges.insert({t[k], t[(k + 1) % 3]}).second);
      EXPECT_TRUE(fans[t[k]].insert({t[(k + 1) % 3], t[(k + 2) % 3]}).second);
    }
  }
  Surface result;
  std::size_t both_ways = 0;
  for (const auto& [a, b] : edges) {
    if (edges.count({b, a}) > 0) {
      ++both_ways;
    } else {
      ++result.boundary_edges;
    }
  }
  for (const auto& fan : fans) {
    EXPECT_FALSE(fan.empty());
    if (fan.empty()) continue;
    std::set<std::uint32_t> ends;
    for (const auto& [from, to] : fan) ends.insert(to);
    auto at = fan.begin();  // where an open fan begins; anywhere in a closed one
    for (auto i = fan.begin(); i != fan.end(); ++i) {
      if (ends.count(i->first) == 0) at = i;
    }
    std::size_t passed = 0;
    for (auto i = at; i != fan.end() && passed < fan.size(); i = fan.find(i->second)) ++passed;
    EXPECT_EQ(passed, fan.size()) << "its triangles are several fans";
  }
  const std::size_t num_edges = both_ways / 2 + result.boundary_edges;
  result.euler_characteristic = static_cast<std::int64_t>(mesh.vertices.size()) -
                                static_cast<std::int64_t>(num_edges) +
                                static_cast<std::int64_t>(mesh.triangles.size());
  return result;
}

void expect_surfaces(TriangleMesh mesh, std::int64_t euler_characteristic, bool closed) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const CoarseMeshes meshes = coarse_meshes(mesh);
    ASSERT_GT(meshes.num_layers(), 5U);
    std::size_t before = 0;
    for (std::uint32_t layers = 1; layers <= meshes.num_layers(); ++layers) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", layers " << layers);
      const CoarseMesh coarse = meshes.mesh(layers);
      const Surface found = surface(coarse);
      EXPECT_EQ(found.euler_characteristic, euler_characteristic);
      EXPECT_EQ(found.boundary_edges == 0, closed);
      EXPECT_GT(coarse.vertices.size(), before);
      before = coarse.vertices.size();
    }
    EXPECT_EQ(before, mesh.num_vertices);
    renumber_by_seed(mesh, seed);
  }
}

TEST(CoarseMesh, OfAClosedSurfaceIsAClosedSurfaceOfTheSameGenus) {
  expect_surfaces(sphere(20, 25), 2, true);
  expect_surfaces(grid_mesh(25, 20, true), 0, true);
}

TEST(CoarseMesh, OfADiscIsADisc) { expect_surfaces(grid_mesh(25, 20, false), 1, false); }

TEST(CoarseMesh, OfAllLayersIsTheMeshWithoutDegenerateTriangles) {
  TriangleMesh mesh = grid_mesh(12, 9, false);
  const Triangles before = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.begin() + 7, {3, 3, 9});
  mesh.triangles.push_back({1, 2, 1});
  const CoarseMeshes meshes = coarse_meshes(mesh);
  for (const std::uint32_t layers : {meshes.num_layers(), meshes.num_layers() + 1, 5000U}) {
    const CoarseMesh whole = meshes.mesh(layers);
    EXPECT_EQ(whole.triangles, before);
    EXPECT_EQ(whole.vertices.size(), mesh.num_vertices);
    EXPECT_TRUE(std::is_sorted(whole.vertices.begin(), whole.vertices.end()));
  }
}

TEST(CoarseMesh, HasTheVerticesOfItsLayers) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = mesh_with_stray_triangles(seed);
    const VertexLayers layers = make_layers(mesh.num_vertices, mesh.triangles);
    const CoarseMeshes meshes = coarse_meshes(mesh);
    ASSERT_EQ(meshes.num_layers(), layers.num_layers);
    for (std::uint32_t n = 1; n <= layers.num_layers; ++n) {
      Indices expected;
      for (std::uint32_t v = 0; v < mesh.num_vertices; ++v) {
        if (layers.layer_of_vertex[v] < n) expected.push_back(v);
      }
      const CoarseMesh coarse = meshes.mesh(n);
      ASSERT_EQ(coarse.vertices, expected);
      ASSERT_EQ(meshes.size(n),
                (MeshSize{static_cast<std::uint32_t>(expected.size()),
                          static_cast<std::uint32_t>(coarse.triangles.size())}));
      for (const Triangle& t : coarse.triangles) {
        ASSERT_LT(*std::max_element(t.begin(), t.end()), expected.size());
        ASSERT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
      }
    }
  }
}

// Removing a vertex leaves the triangles of its ring, with the ring as their outline.
TEST(CoarseMesh, FillsTheHolesOfALayer) {
  const TriangleMesh mesh = grid_mesh(20, 15, true);
  const VertexLayers layers = make_layers(mesh.num_vertices, mesh.triangles);
  const CoarseMeshes meshes = coarse_meshes(mesh);
  for (std::uint32_t n = 1; n < meshes.num_layers(); ++n) {
    const auto edges_of = [](const CoarseMesh& coarse) {
      std::set<Edge> edges;
      for (const Triangle& t : coarse.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
          edges.insert({coarse.vertices[t[k]], coarse.vertices[t[(k + 1) % 3]]});
        }
      }
      return edges;
    };
    const std::set<Edge> edges = edges_of(meshes.mesh(n));
    const std::set<Edge> finer = edges_of(meshes.mesh(n + 1));
    for (std::uint32_t v = 0; v < mesh.num_vertices; ++v) {
      if (layers.layer_of_vertex[v] != n) continue;
      const auto ring = layers.ring[v];
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Edge side{ring[i], ring[(i + 1) % ring.size()]};
        EXPECT_EQ(edges.count(side), 1U) << v;
        EXPECT_EQ(finer.count({v, side.first}), 1U) << v;
      }
    }
  }
}

TEST(CoarseMesh, FollowsTheOutputOrder) {
  const TriangleMesh mesh = grid_mesh(15, 11, true);
  const std::uint32_t n = mesh.num_vertices;
  Indices order(n);
  for (std::uint32_t v = 0; v < n; ++v) order[v] = (8 * v + 5) % n;
  const CoarseMeshes meshes = coarse_meshes(mesh);
  for (std::uint32_t layers = 1; layers <= meshes.num_layers(); ++layers) {
    const CoarseMesh plain = meshes.mesh(layers);
    const CoarseMesh ordered = meshes.mesh(layers, order);
    EXPECT_TRUE(std::is_permutation(plain.vertices.begin(), plain.vertices.end(),
                                    ordered.vertices.begin(), ordered.vertices.end()));
    for (std::size_t i = 1; i < ordered.vertices.size(); ++i) {
      EXPECT_LT(order[ordered.vertices[i - 1]], order[ordered.vertices[i]]);
    }
    ASSERT_EQ(ordered.triangles.size(), plain.triangles.size());
    for (std::size_t t = 0; t < plain.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(ordered.vertices[ordered.triangles[t][k]],
                  plain.vertices[plain.triangles[t][k]]);
      }
    }
  }
}

TEST(CoarseMesh, OfAnEmptyMeshOrOfPointsHasNoTriangles) {
  EXPECT_TRUE(coarse_meshes({0, {}}).mesh(1).vertices.empty());
  const CoarseMesh points = coarse_meshes({3, {}}).mesh(1);
  EXPECT_EQ(points.vertices, (Indices{0, 1, 2}));
  EXPECT_TRUE(points.triangles.empty());
}

// The bounds that LayeredTriangles states.
TEST(CoarseMesh, TriangulationsAddABoundedNumberOfTriangles) {
  const auto all = [](const TriangleMesh& mesh) {
    LayeredTriangles triangles;
    make_layers(mesh.num_vertices, mesh.triangles, &triangles);
    return triangles.size();
  };
  for (const TriangleMesh& mesh : {sphere(30, 40), grid_mesh(50, 40, true)}) {
    EXPECT_LE(all(mesh), 3 * mesh.triangles.size());
    EXPECT_GT(all(mesh), 2 * mesh.triangles.size());
  }
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const TriangleMesh mesh = mesh_with_stray_triangles(seed);
    EXPECT_LE(all(mesh), 6 * mesh.triangles.size()) << seed;
  }
}

std::uint32_t digest_of_coarse_meshes(const TriangleMesh& mesh) {
  Fnv1a digest;
  const CoarseMeshes meshes = coarse_meshes(mesh);
  for (std::uint32_t n = 1; n <= meshes.num_layers(); ++n) {
    const CoarseMesh coarse = meshes.mesh(n);
    digest.add(coarse.vertices);
    for (const Triangle& t : coarse.triangles) digest.add(t);
  }
  return digest.hash();
}

// The digests were computed by the pseudo-code of 8.9.
TEST(CoarseMesh, AgreesWithThePseudoCode) {
  EXPECT_EQ(digest_of_coarse_meshes(sphere(12, 15)), 2327020217U);
  EXPECT_EQ(digest_of_coarse_meshes(grid_mesh(25, 20, false)), 2409040142U);
  EXPECT_EQ(digest_of_coarse_meshes(grid_mesh(25, 20, true)), 540078209U);
}

}  // namespace
}  // namespace rlpc
