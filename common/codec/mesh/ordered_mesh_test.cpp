#include "common/codec/mesh/ordered_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace rlpc {
namespace {

using Indices = std::vector<std::uint32_t>;

Indices copy_of(std::span<const std::uint32_t> list) { return {list.begin(), list.end()}; }

struct LayeredMesh {
  explicit LayeredMesh(std::uint32_t num_vertices, const std::vector<Triangle>& triangles)
      : topology(make_topology(num_vertices, triangles)),
        layers(make_layers(num_vertices, triangles)) {}
  Topology topology;
  VertexLayers layers;
};

// Makes a disc of `rings` rings of 8 vertices around vertex 0.
LayeredMesh disc(std::uint32_t rings) {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t k = (i + 1) % 8;
    triangles.push_back({0, 1 + i, 1 + k});
    for (std::uint32_t r = 0; r + 1 < rings; ++r) {
      const std::uint32_t a = 1 + 8 * r;
      triangles.push_back({a + i, a + 8 + i, a + k});
      triangles.push_back({a + k, a + 8 + i, a + 8 + k});
    }
  }
  return LayeredMesh(1 + 8 * rings, triangles);
}

TEST(OrderedMesh, IsInDecodedOrderWithoutLayers) {
  const LayeredMesh m = disc(3);
  for (const Prediction p :
       {Prediction::kNone, Prediction::kParallelogram, Prediction::kParallelograms}) {
    const OrderedMesh mesh(p, m.topology, m.layers);
    EXPECT_EQ(mesh.prediction(), p);
    EXPECT_EQ(mesh.num_vertices(), 25U);
    EXPECT_EQ(mesh.num_layers(), 1U);
    Indices all(25);
    for (std::uint32_t v = 0; v < 25; ++v) {
      all[v] = v;
      EXPECT_EQ(mesh.layer_of(v), 0U);
      EXPECT_TRUE(mesh.outer_ring(v).empty());
    }
    EXPECT_EQ(copy_of(mesh.order()), all);
    EXPECT_EQ(copy_of(mesh.vertices_of_layers(0, 1)), all);
    EXPECT_EQ(copy_of(mesh.ring(5)), (Indices{0, 4}));
  }
}

TEST(OrderedMesh, RingIsThePreviousVertexWithoutEarlierNeighbours) {
  const LayeredMesh m(4, {{0, 1, 3}});
  const OrderedMesh mesh(Prediction::kNone, m.topology, m.layers);
  EXPECT_EQ(copy_of(mesh.ring(0)), Indices{});
  EXPECT_EQ(copy_of(mesh.ring(1)), Indices{0});
  EXPECT_EQ(copy_of(mesh.ring(2)), Indices{1});
  EXPECT_EQ(copy_of(mesh.ring(3)), (Indices{0, 1}));
}

TEST(OrderedMesh, RingIsTheLastSevenOfManyEarlierNeighbours) {
  std::vector<Triangle> fan;
  for (std::uint32_t i = 0; i < 8; ++i) fan.push_back({i, i + 1, 9});
  const LayeredMesh m(10, fan);
  const OrderedMesh mesh(Prediction::kParallelogram, m.topology, m.layers);
  EXPECT_EQ(copy_of(mesh.ring(9)), (Indices{2, 3, 4, 5, 6, 7, 8}));
}

TEST(OrderedMesh, FollowsTheLayersIfPresent) {
  const LayeredMesh m = disc(6);
  const OrderedMesh mesh(Prediction::kLayers, m.topology, m.layers);
  ASSERT_GT(mesh.num_layers(), 2U);
  EXPECT_EQ(copy_of(mesh.order()), m.layers.layer_order);
  bool outer = false;
  for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
    EXPECT_EQ(mesh.layer_of(v), m.layers.layer_of_vertex[v]);
    EXPECT_EQ(copy_of(mesh.ring(v)), copy_of(m.layers.ring[v]));
    EXPECT_EQ(copy_of(mesh.outer_ring(v)), copy_of(m.layers.outer_ring[v]));
    outer = outer || !mesh.outer_ring(v).empty();
  }
  EXPECT_TRUE(outer);
}

// 8.10.1: any division into groups yields all vertices in order.
TEST(OrderedMesh, LayerGroupsPartitionTheOrder) {
  const LayeredMesh m = disc(6);
  const OrderedMesh mesh(Prediction::kLayers, m.topology, m.layers);
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    Indices joined;
    for (std::uint32_t first = 0; first < mesh.num_layers();) {
      const std::uint32_t end =
          first + 1 + static_cast<std::uint32_t>(random() % (mesh.num_layers() - first));
      for (const std::uint32_t v : mesh.vertices_of_layers(first, end)) {
        EXPECT_GE(mesh.layer_of(v), first);
        EXPECT_LT(mesh.layer_of(v), end);
        joined.push_back(v);
      }
      first = end;
    }
    EXPECT_EQ(joined, copy_of(mesh.order()));
  }
  EXPECT_TRUE(mesh.vertices_of_layers(1, 1).empty());
}

// A decoder knows all vertices of the rings when it reaches a vertex.
TEST(OrderedMesh, RingsComeBeforeTheirVertex) {
  const LayeredMesh m = disc(6);
  for (const Prediction p : {Prediction::kNone, Prediction::kLayers}) {
    const OrderedMesh mesh(p, m.topology, m.layers);
    Indices place(mesh.num_vertices());
    for (std::uint32_t i = 0; i < place.size(); ++i) place[mesh.order()[i]] = i;
    for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
      for (const std::uint32_t u : mesh.ring(v)) EXPECT_LT(place[u], place[v]);
      for (const std::uint32_t u : mesh.outer_ring(v)) EXPECT_LT(place[u], place[v]);
    }
  }
}

}  // namespace
}  // namespace rlpc
